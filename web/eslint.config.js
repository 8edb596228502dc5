// Types are svelte-check's, layout is prettier's; what is left is eslint's.
import js from '@eslint/js'
import svelte from 'eslint-plugin-svelte'
import ts from 'typescript-eslint'
import svelteConfig from './svelte.config.js'

export default ts.config(
  { ignores: ['dist/', 'node_modules/', 'src/api/generated/'] },
  js.configs.recommended,
  ...ts.configs.recommended,
  ...svelte.configs.recommended,
  ...svelte.configs.prettier,
  { files: ['**/*.svelte', '**/*.svelte.ts'], languageOptions: { parserOptions: { parser: ts.parser, svelteConfig } } },
  {
    rules: {
      'no-undef': 'off', // the compiler's
      'no-control-regex': 'off', // texts for terminals and shells are searched for them
      'no-irregular-whitespace': 'off', // a number does not part from its unit
      'svelte/no-unused-svelte-ignore': 'off', // svelte-check's, which says why in the same comment
      'svelte/no-useless-mustaches': 'off', // {' '} keeps a blank
      'svelte/prefer-writable-derived': 'off',
      'svelte/prefer-svelte-reactivity': 'off', // a cache is no state
      eqeqeq: ['error', 'always', { null: 'ignore' }],
      'no-var': 'error',
    },
  },
)
