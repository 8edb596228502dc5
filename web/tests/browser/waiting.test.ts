// What the page says while there is no answer yet.
import type { Page } from 'playwright-core'
import { expect, it } from 'vitest'
import { alone, openPage, place, serve, serveAt, settled, type, withWall } from './program'

const here = place('devices/lhifam.toml')

const answered = (page: Page): Promise<string> => page.locator('.answer').innerText()

it('marks an answer that is of the device before, without a tick', async () => {
  const { page, context, complaints } = await openPage(here, 1280)
  await withWall(page)
  await settled(page)
  expect(await answered(page)).toMatch(/✓ sound[^]*✓ The wall/)
  let free = (): void => {}
  const held = new Promise<void>((done) => (free = done))
  await page.route('**/api/v1/*', async (route) => {
    await held
    await route.continue()
  })
  await type(page, 'body.handle.mass', '4.0')
  await page.locator('.answer.stale').waitFor()
  expect(await answered(page)).toContain('of the device before; computing …')
  expect(await answered(page)).not.toContain('✓')
  expect(await page.locator('#panel-bar').innerText()).toContain('of the device before; computing …')
  expect(await page.locator('#body-bar.stale, #body-limits.stale').count()).toBe(2)
  free()
  await page.locator('.answer:not(.stale)').waitFor()
  await settled(page)
  expect(await answered(page)).toContain('✓ sound')
  expect(await page.locator('.stale').count()).toBe(0)
  expect(complaints).toEqual([])
  await context.close()
})

it('asks again where the program was ended, and goes on when it is started again', async () => {
  const first = await serve('devices/lhifam.toml')
  const { page, context } = await openPage({ browser: here.browser, served: first }, 1280)
  await settled(page)
  const before = await alone(page)
  await first.stop()
  await type(page, 'loop.delay', '0.1 ms')
  await page.locator('.answer .problem', { hasText: /does not answer.*Asked again in \d+ s/ }).waitFor()
  await type(page, 'loop.delay', '0')
  const second = await serveAt(Number(new URL(first.address).port), 'devices/lhifam.toml')
  await page.waitForSelector('[data-answer="alone"]')
  expect(await alone(page)).toBe(before)
  await context.close()
  await second.stop()
})
