// How fast the page is, in print: scripts/bench runs it.
import { expect, it } from 'vitest'
import { openPage, row, settled, show, tabs, withWall } from './program'
import { here, key, opened } from './slider'

it.each([1280, 390])('how soon the first answer is on the screen, %i pixels wide', async (width) => {
  let least = Infinity
  for (let i = 0; i < 5; ++i) {
    const { page, context } = await openPage(here, width)
    least = Math.min(least, await page.evaluate(() => performance.getEntriesByName('first answer')[0]!.startTime))
    await context.close()
  }
  console.log(`first answer on the screen ${least.toFixed(0)} ms after the start of the page, ${width} pixels wide (1000 ms are promised)`)
})

it('how fast a drag is drawn, all panels open', async () => {
  const { page, end } = await opened()
  const session = await page.context().newCDPSession(page)
  await session.send('Performance.setTimeDomain', { timeDomain: 'threadTicks' }) // the page's own work, whatever else the machine does
  await session.send('Performance.enable')
  const work = async (): Promise<number> =>
    (await session.send('Performance.getMetrics')).metrics.find((each) => each.name === 'TaskDuration')!.value * 1000
  const [steps, before] = [200, await work()]
  // From the input of a slider to the frame that shows its answer; it begins with a frame, so these are whole frames.
  const found = await page.evaluate(
    async ([slider, steps]) => {
      const input = document.querySelector<HTMLInputElement>(slider)!
      const shown = document.querySelector('[data-answer="nobody"]')!
      const frame = (): Promise<number> => new Promise((done) => requestAnimationFrame(done))
      const real = window.fetch
      const [requests, times]: [number[], number[]] = [[], []]
      let sent = 0
      window.fetch = async (url, init) => {
        const isAnalysis = String(url).endsWith('/analyze')
        if (isAnalysis) sent = performance.now()
        const response = await real(url, init)
        if (isAnalysis) requests.push(performance.now() - sent)
        return response
      }
      for (let i = 0; i < steps; ++i) {
        const before = shown.textContent
        input.value = String(500 + (i % 2 ? 1 : -1) * (20 + i))
        const start = performance.now()
        input.dispatchEvent(new Event('input', { bubbles: true }))
        while (shown.textContent === before && performance.now() - start < 2000) await frame()
        times.push(performance.now() - start)
      }
      window.fetch = real
      input.dispatchEvent(new Event('change', { bubbles: true }))
      return { requests, times }
    },
    [`[data-key="${key}"] input[type="range"]`, steps] as const,
  )
  const at = (values: number[], share: number): string =>
    [...values].sort((a, b) => a - b)[Math.floor(share * (values.length - 1))]!.toFixed(1)
  const say = (values: number[]): string => `median ${at(values, 0.5)} ms, p95 ${at(values, 0.95)} ms, worst ${at(values, 1)} ms`
  console.log(
    `drag to picture (33 ms are promised): ${say(found.times)}\n  of these the request: ${say(found.requests)}\n  work of the page: ${((await work()) / steps - before / steps).toFixed(1)} ms a step`,
  )
  expect(Math.max(...found.times)).toBeLessThan(2000)
  await end()
})

it.each([
  ['Time', 'simulate'],
  ['Frequency', 'bode'],
] as const)('how often the tab %s is drawn while the wall is dragged on the bar and the sensitivities take a second', async (tab, path) => {
  const { page, context, complaints } = await openPage(here, 1440)
  await withWall(page)
  await show(page, tab)
  await settled(page)
  await page.evaluate(() => {
    const answered: string[] = []
    Object.assign(window, { answered })
    const real = window.fetch
    window.fetch = async (url, init) => {
      const name = String(url).split('/').at(-1)!
      if (name === 'design') await new Promise((done) => setTimeout(done, 1000))
      const response = await real(url, init)
      answered.push(name)
      return response
    }
  })
  const box = (await page.locator('#panel-bar .handle .reach').boundingBox())!
  const [x, y] = [box.x + box.width / 2, box.y + box.height / 2]
  await page.mouse.move(x, y)
  await page.mouse.down()
  const begun = Date.now()
  for (let i = 0; Date.now() - begun < 3500; ++i) await page.mouse.move(x - 100 * Math.sin(i / 20), y)
  const answered = await page.evaluate(() => (window as unknown as { answered: string[] }).answered)
  await page.mouse.up()
  const of = (name: string): number => answered.filter((each) => each === name).length
  console.log(
    `tab ${tab}, 3.5 s of a drag: ${of('analyze')} answers, ${of(path)} of ${path}, ${of('design')} of the sensitivities, held to 1 s`,
  )
  await settled(page)
  expect(complaints).toEqual([])
  await context.close()
})

it.each(tabs)('how the page follows a drag of 10 s with the tab %s open', async (tab) => {
  const { page, context, complaints } = await openPage(here, 1440)
  await withWall(page)
  await show(page, tab)
  if (tab === 'Study') await page.getByRole('button', { name: 'Vary a number' }).click()
  await row(page, key).scrollIntoViewIfNeeded()
  await settled(page)
  await page.evaluate(() => {
    const log = { frames: [] as number[], asked: [] as [path: string, took: number, at: number][] }
    Object.assign(window, { log })
    const real = window.fetch
    window.fetch = async (url, init) => {
      const start = performance.now()
      const response = await real(url, init)
      const path = String(url).split('/').at(-1)!
      void response
        .clone()
        .text()
        .then(
          () => requestAnimationFrame((now) => log.asked.push([path, now - start, now])),
          () => {}, // given up
        )
      return response
    }
    let before = performance.now()
    const frame = (now: number): void => {
      log.frames.push(now - before)
      before = now
      requestAnimationFrame(frame)
    }
    requestAnimationFrame(frame)
  })
  const slider = (await row(page, key).locator('input[type="range"]').boundingBox())!
  const [x, y] = [slider.x + slider.width / 2, slider.y + slider.height / 2]
  await page.mouse.move(x, y)
  await page.mouse.down()
  const begun = Date.now()
  for (let i = 0; Date.now() - begun < 10_000; ++i) {
    await page.mouse.move(x + 0.3 * slider.width * Math.sin(i / 40), y)
    await page.waitForTimeout(8)
  }
  const { frames, asked } = await page.evaluate(
    () => (window as unknown as { log: { frames: number[]; asked: [string, number, number][] } }).log,
  )
  await page.mouse.up()
  const p95 = (values: number[]): string =>
    values.length === 0 ? '–' : [...values].sort((a, b) => a - b)[Math.floor(0.95 * (values.length - 1))]!.toFixed(0)
  const paths = [...new Set(asked.map(([path]) => path))].sort()
  console.log(
    `tab ${tab}: frame p95 ${p95(frames)} ms; ` +
      paths
        .map((path) => {
          const of = asked.filter(([each]) => each === path)
          const gaps = of.slice(1).map(([, , at], i) => at - of[i]![2])
          return `${path} ${of.length} answers, p95 ${p95(of.map(([, took]) => took))} ms to the picture, one every ${p95(gaps)} ms`
        })
        .join('; '),
  )
  await settled(page)
  expect(complaints).toEqual([])
  await context.close()
})

/** Minutes; 0: not measured. */
const heapMinutes = Number(process.env.ZWIDTH_HEAP_MINUTES ?? 0)
it.runIf(heapMinutes > 0)('how much memory the page has after minutes of drags', { timeout: heapMinutes * 60_000 + 200_000 }, async () => {
  const { page, end } = await opened()
  const session = await page.context().newCDPSession(page)
  await session.send('HeapProfiler.enable')
  const heap = async (): Promise<number> => {
    await session.send('HeapProfiler.collectGarbage')
    return (await session.send('Runtime.getHeapUsage')).usedSize / 2 ** 20
  }
  const slider = (await row(page, key).locator('input[type="range"]').boundingBox())!
  const y = slider.y + slider.height / 2
  const found: string[] = []
  const begun = Date.now()
  for (let i = 0, next = 0; Date.now() - begun < heapMinutes * 60_000; ++i) {
    await page.mouse.move(slider.x + slider.width / 2, y)
    await page.mouse.down()
    for (let k = 0; k < 100; ++k) {
      await page.mouse.move(slider.x + slider.width * (0.5 + 0.3 * Math.sin(k / 8)), y)
      await page.waitForTimeout(8)
    }
    await page.mouse.up()
    await show(page, tabs[i % tabs.length]!)
    if (Date.now() - begun < next) continue
    next += 30_000
    found.push((await heap()).toFixed(1))
  }
  console.log(`heap, MiB, every 30 s of drags over all tabs: ${found.join(', ')}`)
  await end()
})
