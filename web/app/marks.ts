/** Durations that the bench and the browser's own profiler show, as performance entries named `posebeat:...`. */

/** Notes how long something took: from `start` (performance.now() then) until now. */
export function measureSince(name: 'decode' | 'analyse' | 'first-dance' | 'whole-dance', start: number): void {
  performance.measure(`posebeat:${name}`, { start: Math.max(0, start), end: performance.now() });
}
