import { svelte } from '@sveltejs/vite-plugin-svelte'
import { defineConfig } from 'vitest/config'

export default defineConfig({
  plugins: [svelte()],
  build: {
    target: 'es2022',
    assetsInlineLimit: 0, // the server's policy allows no data: URI but for images
    modulePreload: { polyfill: false },
    reportCompressedSize: true,
  },
  test: { include: ['tests/unit/**/*.test.ts'], environment: 'node' },
})
