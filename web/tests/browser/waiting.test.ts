// What the page says while there is no answer yet.
import type { Page } from 'playwright-core'
import { expect, it } from 'vitest'
import { askAll, nobody, onEachTab, openPage, place, serve, serveAt, settled, show, tabs, toDevice, type, withWall } from './program'

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
  await show(page, 'Change')
  await expect.poll(() => page.locator('#panel-limits').innerText()).toContain('of the device before; computing …')
  await expect.poll(() => page.locator('#body-limits.stale').count()).toBe(1)
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
  await askAll(page)
  await page.setViewportSize({ width, height: 4000 }) // what is out of view waits
  await onEachTab(page, async () => {})
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
  await type(page, 'body.handle.mass', '4.9')
  await onEachTab(page, async () => {}) // from then on all are known to take long
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
      const of = document.querySelector('[role="tab"][aria-selected="true"]')!.textContent!
      const place = [
        of,
        top('[data-key="loop.delay"]') - top('.numbers'),
        top('.tabs'),
        ...[...document.querySelectorAll('.panel > header')].map((each) => each.getBoundingClientRect().height),
      ].join()
      if (!seen.places.includes(place)) seen.places.push(place)
      requestAnimationFrame(look)
    }
    look()
  })
  await type(page, 'body.handle.mass', '4.8')
  await settled(page)
  await onEachTab(page, async () => {})
  await toDevice(page)
  const seen = await page.evaluate(() => (window as unknown as { seen: { told: string[]; places: string[] } }).seen)
  expect(seen.told.sort()).toEqual([
    'answer',
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
  expect(seen.places).toHaveLength(tabs.length + (width < 900 ? 1 : 0)) // one of each tab
  await expect.poll(() => page.locator('main').innerText()).not.toContain('37 %')
  expect(complaints).toEqual([])
  await context.close()
})
