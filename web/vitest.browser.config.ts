import { defineConfig } from 'vitest/config'

// The page in Chromium against the program itself; see tests/run.
export default defineConfig({
  test: { include: ['tests/browser/**/*.test.ts'], environment: 'node', testTimeout: 60_000, hookTimeout: 20_000, fileParallelism: false },
})
