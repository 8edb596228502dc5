// Who is asked when, while something is dragged.
import { afterEach, beforeEach, describe, expect, it, vi } from 'vitest'
import { Answer } from '../../src/api/answer.svelte'

/** A server that takes so long for each path, in ms; when each was asked and answered. */
interface Log {
  path: string
  at: number
  answered: number
}
let log: Log[] = []
const install = (times: Record<string, number>): void => {
  log = []
  vi.stubGlobal('fetch', (url: string) => {
    const path = url.split('/').at(-1)!
    const entry = { path, at: performance.now(), answered: 0 }
    log.push(entry)
    return new Promise((done) =>
      setTimeout(() => {
        entry.answered = performance.now()
        done({ status: 200, ok: true, headers: new Headers(), json: async () => ({}) })
      }, times[path]),
    )
  })
}
const answered = (path: string): Log[] => log.filter((each) => each.path === path && each.answered > 0)
/** The longest that any of them is without a new answer. */
const longestGap = (path: string): number => {
  const times = answered(path).map((each) => each.answered)
  return Math.max(...times.slice(1).map((time, i) => time - times[i]!))
}
const drag = async (answers: Record<string, Answer<unknown>>, ms: number): Promise<void> => {
  for (let t = 0; t < ms; t += 16) {
    for (const [path, answer] of Object.entries(answers)) answer.ask({ path, toml: String(t) })
    await vi.advanceTimersByTimeAsync(16)
  }
}
beforeEach(() => vi.useFakeTimers())
afterEach(async () => {
  await vi.advanceTimersByTimeAsync(3000) // what is under way ends, and its turn
  vi.useRealTimers()
  vi.unstubAllGlobals()
})

describe('turns', () => {
  it('let what is quick follow a drag, however long something else takes', async () => {
    install({ simulate: 8, design: 500, analyze: 3 })
    await drag({ analyze: new Answer(), simulate: new Answer(true), design: new Answer(true) }, 10_000)
    expect(answered('analyze').length).toBeGreaterThan(300)
    // The first time nobody knows that it is quick.
    expect(answered('simulate').length).toBeGreaterThan(250)
    expect(longestGap('simulate')).toBeLessThanOrEqual(520)
    expect(answered('design').length).toBeGreaterThanOrEqual(9)
    expect(longestGap('design')).toBeLessThanOrEqual(3 * 500)
  })

  it('let those that take long alternate, each within three times of all that they take', async () => {
    install({ region: 100, design: 200, recommend: 300 })
    await drag({ region: new Answer(true), design: new Answer(true), recommend: new Answer(true) }, 10_000)
    for (const path of ['region', 'design', 'recommend']) {
      expect(answered(path).length, path).toBeGreaterThan(10)
      expect(longestGap(path), path).toBeLessThanOrEqual(3 * 300)
    }
  })

  it('let the newest be asked as soon as a drag rests', async () => {
    install({ design: 400 })
    const answer = new Answer(true)
    await drag({ design: answer }, 1000)
    const end = performance.now()
    await vi.advanceTimersByTimeAsync(2000)
    expect(answer.late).toBe(false)
    expect(answer.question?.toml).toBe('992')
    expect(answered('design').at(-1)!.answered - end).toBeLessThanOrEqual(200 + 400 + 400)
  })
})
