// The page as a place to work: as high as its window, with tabs beside the device, and what an uncertain answer looks like.
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs'
import { execFileSync } from 'node:child_process'
import { tmpdir } from 'node:os'
import { afterAll, expect, it } from 'vitest'
import { openPage, place, program, project, row, serve, settled, show, tabs, toDevice } from './program'

const folder = mkdtempSync(`${tmpdir()}/zwidth-`)
const here = place('devices/lhifam.toml')
afterAll(() => rmSync(folder, { recursive: true }))

it.each([1440, 1024, 390])('is as high as its window, on every tab, %i pixels wide', async (width) => {
  const { page, context, complaints } = await openPage(here, width)
  for (const tab of [...(width < 900 ? ['Device'] : []), ...tabs]) {
    await show(page, tab)
    await settled(page)
    const over = await page.evaluate(() => {
      const { scrollWidth, clientWidth, scrollHeight, clientHeight } = document.documentElement
      return [scrollWidth - clientWidth, scrollHeight - clientHeight]
    })
    expect(over, tab).toEqual([0, 0])
    const room = await page.locator(tab === 'Device' ? '.device' : '.sheets').evaluate((each) => each.clientHeight / innerHeight)
    expect(room, tab).toBeGreaterThan(0.4)
  }
  expect(complaints).toEqual([])
  await context.close()
})

it('goes from tab to tab by arrows, as one stop of the keyboard', async () => {
  const { page, context, complaints } = await openPage(here, 1440)
  const focused = (): Promise<string> => page.evaluate(() => document.activeElement?.textContent ?? '')
  await page.getByRole('tab', { name: 'Wall' }).focus()
  await page.keyboard.press('ArrowRight')
  await expect.poll(focused).toBe('Time')
  await expect.poll(() => page.locator('#panel-time').isVisible()).toBe(true)
  await expect.poll(() => page.locator('#panel-region').isVisible()).toBe(false)
  await page.keyboard.press('End')
  await expect.poll(focused).toBe('File')
  await page.keyboard.press('ArrowRight')
  await expect.poll(focused).toBe('Wall')
  expect(await page.getByRole('tab').evaluateAll((all) => all.filter((each) => (each as HTMLElement).tabIndex === 0).length)).toBe(1)
  // Tab goes from number to number: the heading of a part that is open is no stop.
  await row(page, 'body.motor.coulomb').locator('input[type="text"]').focus()
  await page.keyboard.press('Tab')
  await expect.poll(() => page.locator('[data-key]:has(input:focus)').getAttribute('data-key')).toBe('body.handle.mass')
  expect(complaints).toEqual([])
  await context.close()
})

it('asks nothing of a tab that is not shown, and forgets nothing of one that was', async () => {
  const { page, context, complaints } = await openPage(here, 1440)
  const asked: string[] = []
  page.on('request', (request) => asked.push(request.url().split('/').at(-1)!))
  await row(page, 'loop.delay').locator('input[type="text"]').fill('0.1 ms')
  await page.keyboard.press('Enter')
  await settled(page)
  expect(asked).toContain('region')
  for (const other of ['bode', 'simulate', 'diagnose', 'relay', 'frf']) expect(asked).not.toContain(other)
  await show(page, 'Frequency')
  await settled(page)
  expect(asked).toContain('bode')
  await show(page, 'Recording')
  await page.getByLabel(/choose it/).setInputFiles(`${project}/recordings/locked_chirp.csv`)
  await page.getByRole('button', { name: 'Fit', exact: true }).waitFor()
  await show(page, 'Wall')
  await show(page, 'Recording')
  await page.getByRole('button', { name: 'Fit', exact: true }).waitFor()
  expect(complaints).toEqual([])
  await context.close()
})

it.each([1440, 390])('shows an uncertain answer as its interval, on the bar too, %i pixels wide', async (width) => {
  const file = `${folder}/fitted.toml`
  const words = 'identify recordings/locked_chirp.csv --structure devices/lhifam.toml --force force --position position --locked handle'
  writeFileSync(file, execFileSync(program, [...words.split(' '), '--output-device', '-'], { cwd: project, encoding: 'utf8' }))
  const { critical_stiffness_interval: interval } = JSON.parse(
    execFileSync(program, ['analyze', file, '--json'], { encoding: 'utf8' }),
  ) as {
    critical_stiffness_interval: [number, number]
  }
  const other = await serve(file)
  const { page, context, complaints } = await openPage({ browser: here.browser, served: other }, width)
  const [low, high] = interval.map((each) => Number((each / 1000).toPrecision(3)))
  await expect.poll(() => page.locator('[data-answer="nobody-interval"]').innerText()).toBe(`${low} to ${high} kN/m`)
  await settled(page)
  // From the one end to the other, as the axis has them.
  const drawn = await page
    .locator('#panel-bar .uncertain')
    .first()
    .evaluate((each) => each.getBoundingClientRect().width)
  expect(drawn).toBeGreaterThan(2)
  await toDevice(page)
  await expect.poll(() => page.locator('.answer-words').innerText()).toContain('in 95 %')
  expect(complaints).toEqual([])
  await context.close()
  await other.stop()
})

it('begins, opens and saves from its menu, and shows in which colours it is', async () => {
  const { page, context, complaints } = await openPage(here, 1440)
  const menu = page.getByRole('button', { name: 'New, open' })
  await menu.click()
  await page.locator('.examples').getByRole('button', { name: 'Quanser Rotary Torsion' }).click()
  await expect.poll(() => page.locator('h1').innerText()).toBe('Quanser Rotary Torsion')
  await expect.poll(() => page.locator('.menu-body').isVisible()).toBe(false)
  await menu.click()
  await page.keyboard.press('Escape')
  await expect.poll(() => page.locator('.menu-body').isVisible()).toBe(false)
  await page.getByRole('button', { name: 'Colours: auto' }).click()
  await page.getByRole('button', { name: 'Colours: light' }).click()
  await expect.poll(() => page.evaluate(() => getComputedStyle(document.body).backgroundColor)).not.toBe('rgb(255, 255, 255)')
  await page.getByRole('button', { name: 'Help' }).click()
  await page.getByRole('dialog', { name: 'Help' }).getByRole('button', { name: 'Close' }).click()
  expect(complaints).toEqual([])
  await context.close()
})
