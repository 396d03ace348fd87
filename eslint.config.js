import js from '@eslint/js';
import prettier from 'eslint-config-prettier';
import jsdoc from 'eslint-plugin-jsdoc';
import globals from 'globals';
import tseslint from 'typescript-eslint';

/** Rooms of the house and what each must not reach for: core is pure; nothing below ui and app knows them. */
const room = (files, forbidden, message) => ({
  files,
  rules: { 'no-restricted-imports': ['error', { patterns: [{ group: forbidden, message }] }] },
});

export default tseslint.config(
  { ignores: ['dist', 'node_modules', 'export/.venv', 'test-results', 'playwright-report', 'public'] },
  js.configs.recommended,
  ...tseslint.configs.strict,
  {
    languageOptions: { globals: { ...globals.browser, ...globals.node, ...globals.worker } },
    rules: {
      '@typescript-eslint/no-non-null-assertion': 'off',
      '@typescript-eslint/consistent-type-imports': 'error',
      eqeqeq: 'error',
    },
  },
  {
    files: ['web/**/*.{ts,tsx}'],
    plugins: { jsdoc },
    rules: {
      'jsdoc/require-jsdoc': [
        'error',
        {
          publicOnly: true,
          require: { FunctionDeclaration: true, ClassDeclaration: true },
          contexts: ['TSInterfaceDeclaration'],
        },
      ],
    },
  },
  room(
    ['web/core/**'],
    [
      'three',
      'three/*',
      'onnxruntime*',
      'preact*',
      '@preact/*',
      '**/audio/*',
      '**/workers/*',
      '**/scene/*',
      '**/ui/*',
      '**/app/*',
    ],
    'web/core is pure: no DOM, no three, no onnxruntime, no other room.',
  ),
  {
    files: ['web/core/**'],
    rules: {
      'no-restricted-globals': [
        'error',
        'window',
        'document',
        'self',
        'navigator',
        'localStorage',
        'indexedDB',
        'fetch',
        'Worker',
        'postMessage',
        'AudioContext',
        'HTMLElement',
        'requestAnimationFrame',
        'process',
      ],
    },
  },
  room(
    ['web/workers/**'],
    ['three', 'three/*', 'preact*', '**/scene/*', '**/ui/*', '**/app/*'],
    'Workers know only core.',
  ),
  room(
    ['web/scene/**'],
    ['preact*', '**/workers/*', '**/ui/*', '**/app/*', '**/audio/*'],
    'The scene knows only core and three.',
  ),
  room(
    ['web/audio/**'],
    ['three', 'three/*', 'preact*', '**/scene/*', '**/ui/*', '**/app/*'],
    'Audio knows only core.',
  ),
  room(['web/app/**'], ['**/ui/*'], 'The app layer never depends on the ui.'),
  prettier,
);
