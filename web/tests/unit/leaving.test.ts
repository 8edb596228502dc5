// What is no longer asked is given up, and how far long work is.
import { afterEach, expect, it, vi } from 'vitest'
import { Answer } from '../../src/api/answer.svelte'

interface Asked {
  toml: string
  signal: AbortSignal
  reply: (response: Response) => void
}
let asked: Asked[] = []
const install = (): void => {
  asked = []
  vi.useFakeTimers()
  vi.stubGlobal('fetch', (_: string, init: RequestInit) => {
    const { device_toml: toml } = JSON.parse(init.body as string) as { device_toml: string }
    return new Promise<Response>((done, failed) => {
      const signal = init.signal!
      signal.addEventListener('abort', () => failed(new DOMException('left', 'AbortError')))
      asked.push({ toml, signal, reply: done })
    })
  })
}
afterEach(() => {
  vi.unstubAllGlobals()
  vi.useRealTimers()
})

it('leaves work on what is no longer asked after a second, and asks the newest', async () => {
  install()
  const answer = new Answer<{ n: number }>()
  answer.ask({ path: 'analyze', toml: 'x = 0' })
  await vi.advanceTimersByTimeAsync(300)
  for (const value of [1, 2]) answer.ask({ path: 'analyze', toml: `x = ${value}` })
  await vi.advanceTimersByTimeAsync(650)
  expect([asked.length, asked[0]!.signal.aborted]).toEqual([1, false]) // it may still be done within its second
  await vi.advanceTimersByTimeAsync(100)
  expect(asked.map((each) => each.toml)).toEqual(['x = 0', 'x = 2'])
  expect([asked[0]!.signal.aborted, answer.problem, answer.late]).toEqual([true, null, true])
  await vi.advanceTimersByTimeAsync(20_000)
  expect(asked[1]!.signal.aborted).toBe(false) // nothing newer is asked
  asked[1]!.reply({ status: 200, ok: true, json: async () => ({ n: 2 }) } as Response)
  await vi.advanceTimersByTimeAsync(1)
  expect([answer.document, answer.late]).toEqual([{ n: 2 }, false])
})

it('leaves at once what is of another device, and what nobody asks any more', async () => {
  install()
  const answer = new Answer()
  answer.ask({ path: 'region', toml: 'name = "one"' })
  answer.ask({ path: 'region', toml: 'name = "two"' })
  await vi.advanceTimersByTimeAsync(1)
  expect(asked.map((each) => [each.toml, each.signal.aborted])).toEqual([
    ['name = "one"', true],
    ['name = "two"', false],
  ])
  answer.ask(null)
  await vi.advanceTimersByTimeAsync(1)
  expect([asked.length, asked[1]!.signal.aborted, answer.problem, answer.late]).toEqual([2, true, null, false])
})

it('says how far long work is, and takes document and error from the last line', async () => {
  install()
  const answer = new Answer<{ n: number }>(true)
  const lines = (): { response: Response; put: (text: string) => Promise<unknown>; end: () => Promise<unknown> } => {
    const { readable, writable } = new TransformStream<Uint8Array, Uint8Array>()
    const writer = writable.getWriter()
    const response = new Response(readable, { headers: { 'Content-Type': 'application/x-ndjson' } })
    return {
      response,
      put: async (text) => (await writer.write(new TextEncoder().encode(text)), vi.advanceTimersByTimeAsync(1)),
      end: async () => (await writer.close(), vi.advanceTimersByTimeAsync(1)),
    }
  }
  answer.ask({ path: 'design', toml: 'x = 1' })
  await vi.advanceTimersByTimeAsync(1)
  const first = lines()
  asked[0]!.reply(first.response)
  await vi.advanceTimersByTimeAsync(200)
  expect(answer.waits).toBe('computing …')
  await first.put('{"progress":0.25}\n{"progr')
  expect(answer.waits).toBe('computing … 25 %')
  await first.put('ess":0.5}\n')
  expect(answer.waits).toBe('computing … 50 %')
  await first.put('{"n":1}\n')
  await first.end()
  expect([answer.document, answer.waits]).toEqual([{ n: 1 }, ''])
  answer.ask({ path: 'design', toml: 'x = -1' })
  await vi.advanceTimersByTimeAsync(300)
  const second = lines()
  asked[1]!.reply(second.response)
  await second.put('{"error":{"where":"device.x","what":"is -1","allowed":"above 0"}}\n')
  await second.end()
  expect([answer.document, answer.problem?.where, answer.problem?.isPassing]).toEqual([null, 'device.x', false])
})
