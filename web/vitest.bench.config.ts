import { defineConfig } from 'vitest/config'
import browser from './vitest.browser.config'

// What is timed, and nothing beside it.
export default defineConfig({ test: { ...browser.test, include: ['tests/browser/speed.bench.ts'], maxWorkers: 1 } })
