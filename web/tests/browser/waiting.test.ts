// What the page says while there is no answer yet.
import type { Page } from 'playwright-core'
import { expect, it } from 'vitest'
import { nobody, openAll, openPage, place, serve, serveAt, settled, type, withWall } from './program'

const here = place('devices/lhifam.toml')

const answered = (page: Page): Promise<string> => page.locator('.answer').innerText()

it('marks an answer that is of the device before, without a tick', async () => {
  const { page, context, complaints } = await openPage(here, 1280)
  await withWall(page)
  await settled(page)
  await expect.poll(() => answered(page)).toMatch(/✓ sound[^]*✓ The wall/)
  let free = (): void => {}
  const held = new Promise<void>((done) => (free = done))
  await page.route('**/api/v1/*', async (route) => {
    await held
    await route.continue()
  })
  await type(page, 'body.handle.mass', '4.0')
  await page.locator('.answer.stale').waitFor()
  await expect.poll(() => answered(page)).toContain('of the device before; computing …')
  expect(await answered(page)).not.toContain('✓')
  await expect.poll(() => page.locator('#panel-bar').innerText()).toContain('of the device before; computing …')
  await expect.poll(() => page.locator('#body-bar.stale, #body-limits.stale').count()).toBe(2)
  free()
  await page.locator('.answer:not(.stale)').waitFor()
  await settled(page)
  await expect.poll(() => answered(page)).toContain('✓ sound')
  await expect.poll(() => page.locator('.stale').count()).toBe(0)
  expect(complaints).toEqual([])
  await context.close()
})

it('asks again where the program was ended, and goes on when it is started again', async () => {
  const first = await serve('devices/lhifam.toml')
  const { page, context } = await openPage({ browser: here.browser, served: first }, 1280)
  await settled(page)
  const before = await nobody(page)
  await first.stop()
  await type(page, 'loop.delay', '0.1 ms')
  await page.locator('.answer .problem', { hasText: /does not answer.*Asked again in \d+ s/ }).waitFor()
  await type(page, 'loop.delay', '0')
  const second = await serveAt(Number(new URL(first.address).port), 'devices/lhifam.toml')
  await page.waitForSelector('[data-answer="nobody"]')
  await expect.poll(() => nobody(page)).toBe(before)
  await context.close()
  await second.stop()
})

it.each([1280, 390])('says in every panel of long work how far it is, and lets nothing jump meanwhile, %i pixels wide', async (width) => {
  const { page, context, complaints } = await openPage(here, width)
  await withWall(page)
  await openAll(page)
  await page.setViewportSize({ width, height: 9000 }) // what is out of view waits
  await settled(page)
  // Every answer takes long, and tells after a while that it is done by 37 %.
  await page.evaluate(() => {
    const real = window.fetch
    const wait = (): Promise<void> => new Promise((done) => setTimeout(done, 1500))
    window.fetch = async (url, init) => {
      const tells = new Headers(init?.headers).get('Accept')?.includes('ndjson') ?? false
      const response = await real(url, { ...init, headers: { 'Content-Type': 'application/json' } })
      const document = await response.text()
      if (!tells) await wait()
      if (!tells) return new Response(document, { status: response.status, headers: { 'Content-Type': 'application/json' } })
      const body = new ReadableStream({
        async start(stream) {
          stream.enqueue(new TextEncoder().encode('{"progress":0.3700}\n'))
          await wait()
          stream.enqueue(new TextEncoder().encode(document))
          stream.close()
        },
      })
      return new Response(body, { status: 200, headers: { 'Content-Type': 'application/x-ndjson' } })
    }
  })
  await type(page, 'body.handle.mass', '4.9') // from then on all are known to take long
  await settled(page)
  await page.evaluate(() => {
    const seen = { told: [] as string[], places: [] as string[] }
    Object.assign(window, { seen })
    const look = (): void => {
      for (const each of document.querySelectorAll('[data-panel], .numbers')) {
        const name = each.getAttribute('data-panel') ?? 'numbers'
        const text = each.querySelector(':scope > .late, :scope > header .late')?.textContent ?? ''
        if (text.includes('37 %') && !seen.told.includes(name)) seen.told.push(name)
      }
      const top = (selector: string): number => document.querySelector(selector)!.getBoundingClientRect().top
      const place = [
        top('[data-key="loop.delay"]') - top('.numbers'),
        ...[...document.querySelectorAll('.panel > header')].map((each) => each.getBoundingClientRect().height),
      ].join()
      if (!seen.places.includes(place)) seen.places.push(place)
      requestAnimationFrame(look)
    }
    look()
  })
  await type(page, 'body.handle.mass', '4.8')
  await settled(page)
  const seen = await page.evaluate(() => (window as unknown as { seen: { told: string[]; places: string[] } }).seen)
  expect(seen.told.sort()).toEqual([
    'answer',
    'bar',
    'bode',
    'compare',
    'diagnose',
    'file',
    'limits',
    'numbers',
    'recommend',
    'region',
    'relay',
    'sweep',
    'time',
  ])
  expect(seen.places).toHaveLength(1)
  await expect.poll(() => page.locator('main').innerText()).not.toContain('37 %')
  expect(complaints).toEqual([])
  await context.close()
})
