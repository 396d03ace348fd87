export declare const CHROMIUM_FLAGS: string[];
export declare function installedChromium(): string | undefined;
export declare function ensureChromium(): void;
