import { afterEach, beforeEach, describe, expect, it, vi } from 'vitest'
import { Answer } from '../../src/api/answer.svelte'
import { Problem } from '../../src/api/client'

interface Asked {
  toml: string
  reply: (status: number, body: unknown) => void
}
let asked: Asked[] = []
const install = (): void => {
  asked = []
  vi.stubGlobal('fetch', (_: string, init: RequestInit) => {
    const toml = (JSON.parse(init.body as string) as { device_toml: string }).device_toml
    return new Promise<Response>((done) =>
      // A plain object: a Response reads its body when the machine comes to it.
      asked.push({ toml, reply: (status, body) => done({ status, ok: status === 200, json: async () => body } as Response) }),
    )
  })
}
// The time is the test's, however busy the machine is.
const pause = async (ms: number): Promise<void> => void (await vi.advanceTimersByTimeAsync(ms))
const turn = (): Promise<void> => pause(5)
beforeEach(() => void vi.useFakeTimers())
afterEach(() => {
  vi.useRealTimers()
  vi.unstubAllGlobals()
})

describe('answer', () => {
  it('has one request in flight, and the newest wins', async () => {
    install()
    const answer = new Answer<{ n: number }>()
    for (let i = 0; i < 10; ++i) answer.ask({ path: 'analyze', toml: String(i) })
    expect(asked.map((each) => each.toml)).toEqual(['0'])
    expect(answer.late).toBe(true)
    asked[0]!.reply(200, { n: 0 })
    await turn()
    expect(answer.document).toEqual({ n: 0 })
    expect(answer.late).toBe(true)
    expect(asked.map((each) => each.toml)).toEqual(['0', '9'])
    asked[1]!.reply(200, { n: 9 })
    await turn()
    expect(answer.document).toEqual({ n: 9 })
    expect(answer.late).toBe(false)
    expect(asked).toHaveLength(2)
  })

  it('is not late when what is shown is asked for again', async () => {
    install()
    const answer = new Answer()
    answer.ask({ path: 'analyze', toml: 'a' })
    asked[0]!.reply(200, {})
    await turn()
    answer.ask({ path: 'analyze', toml: 'a' })
    expect(answer.late).toBe(false)
    expect(asked).toHaveLength(1)
  })

  it('takes no number from before an error', async () => {
    install()
    const answer = new Answer()
    answer.ask({ path: 'analyze', toml: 'good' })
    asked[0]!.reply(200, { n: 1 })
    await turn()
    answer.ask({ path: 'analyze', toml: 'bad' })
    asked[1]!.reply(400, { error: { where: 'device.body.a.mass', what: 'is -1', allowed: '> 0' } })
    await turn()
    expect(answer.document).toBeNull()
    expect(answer.problem).toBeInstanceOf(Problem)
    expect(answer.problem?.where).toBe('device.body.a.mass')
    expect(answer.late).toBe(false)
  })

  it('asks again where the server is busy', async () => {
    install()
    const answer = new Answer()
    answer.ask({ path: 'analyze', toml: 'a' })
    asked[0]!.reply(503, { error: { what: 'busy' } })
    await pause(150)
    expect(asked).toHaveLength(2)
    asked[1]!.reply(200, { n: 1 })
    await turn()
    expect(answer.document).toEqual({ n: 1 })
  })

  it('asks again, ever later, where the server is gone', async () => {
    vi.useFakeTimers()
    let count = 0
    let isGone = true
    vi.stubGlobal(
      'fetch',
      () => (
        ++count,
        isGone
          ? Promise.reject(new TypeError('gone'))
          : Promise.resolve({ status: 200, ok: true, json: async () => ({ n: 1 }) } as Response)
      ),
    )
    const answer = new Answer<{ n: number }>()
    answer.ask({ path: 'analyze', toml: 'a' })
    const counts: number[] = []
    for (const seconds of [0, 1, 2, 4, 8, 16, 30, 30]) {
      await vi.advanceTimersByTimeAsync(seconds * 1000)
      counts.push(count)
      expect(answer.document).toBeNull()
    }
    expect(counts).toEqual([1, 2, 3, 4, 5, 6, 7, 8])
    expect(answer.problem?.retry).toBe(' Asked again in 30 s.')
    answer.ask({ path: 'analyze', toml: 'b' }) // at once
    await vi.advanceTimersByTimeAsync(1)
    expect(count).toBe(9)
    isGone = false
    await vi.advanceTimersByTimeAsync(30_000)
    expect([answer.document, answer.problem, answer.late]).toEqual([{ n: 1 }, null, false])
    await vi.advanceTimersByTimeAsync(100_000)
    expect(count).toBe(10)
    vi.useRealTimers()
  })

  it('shows nothing of another device', async () => {
    install()
    const answer = new Answer()
    const [one, stiffer, two] = ['name = "one"', 'name = "one"\nx = 2', 'name = "two"']
    answer.ask({ path: 'region', toml: one })
    asked[0]!.reply(200, { of: 'one' })
    await turn()
    answer.ask({ path: 'region', toml: stiffer })
    expect(answer.document).toEqual({ of: 'one' })
    answer.ask({ path: 'region', toml: two })
    expect(answer.document).toBeNull()
    asked[1]!.reply(200, { of: 'one, stiffer' })
    await turn()
    expect(answer.document).toBeNull()
    expect(answer.late).toBe(true)
    asked[2]!.reply(200, { of: 'two' })
    await turn()
    expect(answer.document).toEqual({ of: 'two' })
    expect(answer.late).toBe(false)
  })

  it('lags where what it shows is of another question for more than 50 ms, and not while it follows', async () => {
    install()
    const answer = new Answer<{ n: number }>()
    answer.ask({ path: 'analyze', toml: '0' })
    asked[0]!.reply(200, { n: 0 })
    await turn()
    for (let i = 1; i <= 8; ++i) {
      answer.ask({ path: 'analyze', toml: `${i}` })
      await pause(20)
      answer.ask({ path: 'analyze', toml: `${i}.5` })
      await pause(20)
      asked.at(-1)!.reply(200, { n: i })
      await turn()
      expect(answer.lags, `${i}`).toBe(false)
      asked.at(-1)!.reply(200, { n: i + 0.5 })
      await turn()
    }
    expect(answer.late).toBe(false)
    answer.ask({ path: 'analyze', toml: '10' })
    await pause(200)
    expect([answer.lags, answer.document]).toEqual([true, { n: 8.5 }])
    answer.ask({ path: 'analyze', toml: '11' })
    await pause(200)
    asked.at(-1)!.reply(200, { n: 10 })
    await turn()
    expect([answer.lags, answer.document]).toEqual([true, { n: 10 }]) // of what was replaced 200 ms ago
    asked.at(-1)!.reply(200, { n: 11 })
    await turn()
    expect([answer.lags, answer.late]).toEqual([false, false])
  })

  it('waits out of view until the questions rest, and comes at once in view', async () => {
    install()
    const answer = new Answer()
    answer.seen('out')
    answer.ask({ path: 'bode', toml: 'a' })
    answer.ask({ path: 'bode', toml: 'b' })
    expect(asked).toHaveLength(0)
    expect(answer.late).toBe(true)
    answer.seen('in')
    expect(asked.map((each) => each.toml)).toEqual(['b'])
    asked[0]!.reply(200, {})
    await turn()
    answer.seen('out')
    answer.ask({ path: 'bode', toml: 'c' })
    await pause(350)
    expect(asked.map((each) => each.toml)).toEqual(['b', 'c'])
  })

  it('forgets what is no longer asked', async () => {
    install()
    const answer = new Answer()
    answer.ask({ path: 'analyze', toml: 'a' })
    answer.ask(null)
    asked[0]!.reply(200, { n: 1 })
    await turn()
    expect(answer.document).toBeNull()
    expect(answer.late).toBe(false)
  })
})
