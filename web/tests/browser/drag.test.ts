import { expect, it } from 'vitest'
import { nobody, documentOf, row, settled } from './program'
import { key, opened } from './slider'

const fourDigits = (value: number): number => Number(value.toPrecision(4))
const stiffness = (text: string): number => fourDigits(Number.parseFloat(text) * (text.endsWith(' kN/m') ? 1000 : 1))

interface Log {
  asked: { panel: string; body: string; inFlight: number; value?: string }[]
  shown: string[]
}
it('through a drag: one request in flight per panel, nothing goes backwards, nothing is stale at the end', async () => {
  const { page, end } = await opened()
  await page.evaluate(() => {
    const log: Log = { asked: [], shown: [] }
    Object.assign(window, { log })
    const real = window.fetch
    const running = new Map<string, number>()
    window.fetch = async (url, init) => {
      const body = String(init?.body)
      const path = String(url).split('/').at(-1)!
      const panel = path + JSON.stringify((JSON.parse(body) as { options: unknown }).options)
      running.set(panel, (running.get(panel) ?? 0) + 1)
      const entry: Log['asked'][number] = { panel, body, inFlight: running.get(panel)! }
      log.asked.push(entry)
      try {
        const response = await real(url, init)
        if (path === 'analyze') {
          const document = (await response.clone().text()).trim().split('\n').at(-1)! // after lines of progress, where it is slow
          entry.value = String((JSON.parse(document) as { critical_stiffness: number }).critical_stiffness)
        }
        return response
      } finally {
        running.set(panel, running.get(panel)! - 1) // given up as well, which a slow answer is
      }
    }
    const look = (): void => {
      const text = document.querySelector('[data-answer="nobody"]')?.textContent ?? ''
      if (log.shown.at(-1) !== text) log.shown.push(text)
      requestAnimationFrame(look)
    }
    look()
  })
  const slider = (await row(page, key).locator('input[type="range"]').boundingBox())!
  const y = slider.y + slider.height / 2
  const [from, to] = [slider.x + 0.1 * slider.width, slider.x + 0.9 * slider.width]
  await page.mouse.move(from, y)
  await page.mouse.down()
  const rests = 12 // in between, more is asked than is answered
  const movesEach = 6
  for (let i = 1; i <= rests * movesEach; ++i) {
    await page.mouse.move(from + (i / rests / movesEach) * (to - from), y)
    if (i % movesEach === 0) await page.locator('.answer[aria-busy="false"]').waitFor()
  }
  await page.mouse.up()
  await settled(page)
  const log = await page.evaluate(() => (window as unknown as { log: Log }).log)
  const analyses = log.asked.filter((each) => each.panel.startsWith('analyze'))
  console.log(`${log.asked.length} requests, ${analyses.length} of them the analysis; ${log.shown.length} answers seen`)
  expect(analyses.length).toBeGreaterThanOrEqual(rests)
  expect(log.asked.filter((each) => each.inFlight > 1)).toEqual([])
  // The damping only grows, so each answer seen belongs to a later question than the one before.
  const order = analyses.map((each) => fourDigits(Number(each.value)))
  let last = 0
  for (const text of log.shown.slice(1)) {
    const at = order.indexOf(stiffness(text), last)
    expect(at, `${text} after ${order[last]}`).toBeGreaterThanOrEqual(last)
    last = at
  }
  // What every panel asked last is what stands there now.
  const damping = /name = "handle"[^[]*\ndamping = (\S+)/.exec(
    (JSON.parse(analyses.at(-1)!.body) as { device_toml: string }).device_toml,
  )![1]!
  const newest = new Map(log.asked.map((each) => [each.panel, each.body]))
  for (const [panel, body] of newest) expect(body, panel).toContain(`damping = ${damping}`)
  const answer = documentOf('analyze', 'devices/lhifam.toml', '--set', `${key}=${damping}`)
  expect(stiffness(await nobody(page))).toBe(fourDigits(Number(answer.critical_stiffness)))
  await end()
})
