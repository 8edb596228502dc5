import { defineConfig } from 'vitest/config'

// The page in Chromium against the program itself, each file with a server and a browser of its own; see tests/run.
// A page mostly waits: more files at a time than processors. Waits are long, for machines that are busy or slow.
export default defineConfig({
  test: {
    include: ['tests/browser/**/*.test.ts'],
    environment: 'node',
    testTimeout: 200_000,
    hookTimeout: 60_000,
    expect: { poll: { timeout: 90_000 } },
    minWorkers: 1,
    maxWorkers: 3,
  },
})
