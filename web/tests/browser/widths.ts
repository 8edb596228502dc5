// What holds at every width: the answer, numbers, drags, errors, links, recordings; and for everybody.
import axe from 'axe-core'
import type { Page } from 'playwright-core'
import { expect, it } from 'vitest'
import {
  addressOf,
  askAll,
  documentOf,
  nobody,
  onEachTab,
  openPage,
  place,
  project,
  row,
  runPalette,
  settled,
  show,
  toDevice,
  type,
  withWall,
} from './program'

/** What axe finds on the page as it stands. */
const violations = (page: Page): Promise<string[]> =>
  page.evaluate(async () => {
    const results = await (window as unknown as { axe: typeof axe }).axe.run(document, { resultTypes: ['violations'] })
    return results.violations.map(
      (each) =>
        `${each.id}: ${each.nodes
          .slice(0, 3)
          .map((node) => `${node.html.slice(0, 160)} ${node.failureSummary ?? ''}`)
          .join(' | ')} (${each.nodes.length})`,
    )
  })

export function everythingAt(width: number): void {
  const here = place('devices/lhifam.toml')

  it('shows the program’s own answer, and asks nobody else', async () => {
    const { page, context, complaints } = await openPage(here, width)
    const answer = documentOf('analyze', 'devices/lhifam.toml')
    await expect.poll(() => nobody(page)).toBe(`${(Number(answer.critical_stiffness) / 1000).toPrecision(4)} kN/m`)
    await expect.poll(() => page.locator('[data-answer="limited-by"]').innerText()).toContain('the rigid body')
    await expect.poll(() => page.locator('[data-answer="trust"]').innerText()).toContain('sound')
    await expect.poll(() => page.evaluate(() => performance.getEntriesByType('resource').length)).toBeLessThan(20)
    await settled(page)
    await expect
      .poll(() => page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth))
      .toBeLessThanOrEqual(0)
    expect(complaints).toEqual([])
    await context.close()
  })

  it('takes numbers with units, by key and by drag, and takes them back', async () => {
    const { page, context, complaints } = await openPage(here, width)
    await type(page, 'loop.delay', '0.25 ms')
    await settled(page)
    const delayed = documentOf('analyze', 'devices/lhifam.toml', '--set', 'loop.delay=0.25 ms')
    await expect.poll(() => nobody(page)).toBe(`${(Number(delayed.critical_stiffness) / 1000).toPrecision(4)} kN/m`)
    const text = row(page, 'loop.delay').locator('input[type="text"]')
    await expect.poll(() => text.inputValue()).toBe('0.25 ms')
    await text.press('ArrowUp')
    await expect.poll(() => text.inputValue()).toBe('0.2525 ms')
    await text.press('Shift+ArrowUp')
    await expect.poll(() => text.inputValue()).toBe('0.2778 ms')
    await text.press('PageUp')
    await expect.poll(() => text.inputValue()).toBe('0.5556 ms')
    const slider = row(page, 'loop.delay').locator('input[type="range"]')
    await slider.focus()
    await slider.press('Home')
    await expect.poll(() => text.inputValue()).toBe('0 ms')
    for (let i = 0; i < 5; ++i) await page.keyboard.press('Control+z')
    await expect.poll(() => text.inputValue()).toBe('0 s')
    await settled(page)
    await expect.poll(() => nobody(page)).toBe('8.849 kN/m')

    // A drag of the slider is one step.
    const box = (await row(page, 'link.0.stiffness').locator('input[type="range"]').boundingBox())!
    await row(page, 'link.0.stiffness').scrollIntoViewIfNeeded()
    const now = (await row(page, 'link.0.stiffness').locator('input[type="range"]').boundingBox()) ?? box
    await page.mouse.move(now.x + now.width / 2, now.y + now.height / 2)
    await page.mouse.down()
    for (let i = 1; i <= 10; ++i) await page.mouse.move(now.x + now.width / 2 + 2 * i, now.y + now.height / 2)
    await page.mouse.up()
    await expect.poll(() => row(page, 'link.0.stiffness').locator('input[type="text"]').inputValue()).not.toBe('79.5 kN/m')
    await page.keyboard.press('Control+z')
    await expect.poll(() => row(page, 'link.0.stiffness').locator('input[type="text"]').inputValue()).toBe('79.5 kN/m')
    await page.keyboard.press('Control+Shift+z')
    await expect.poll(() => row(page, 'link.0.stiffness').locator('input[type="text"]').inputValue()).not.toBe('79.5 kN/m')
    expect(complaints).toEqual([])
    await context.close()
  })

  it('takes a bare number as SI; nothing of the text before it sticks', async () => {
    const { page, context, complaints } = await openPage(here, width)
    const field = (key: string) => row(page, key).locator('input[type="text"]')
    await type(page, 'link.0.stiffness', '79500')
    await expect.poll(() => field('link.0.stiffness').inputValue()).toBe('79.5 kN/m')
    await type(page, 'link.0.stiffness', '65 N/mm')
    await expect.poll(() => field('link.0.stiffness').inputValue()).toBe('65 N/mm')
    await type(page, 'link.0.stiffness', '79500')
    await expect.poll(() => field('link.0.stiffness').inputValue()).toBe('79.5 kN/m')
    await expect.poll(() => field('link.0.stiffness').getAttribute('title')).toContain('79500 or 79.5 kN/m')
    await settled(page)
    await expect.poll(() => nobody(page)).toBe('8.849 kN/m')
    await type(page, 'sensor.resolution', '4096 counts')
    await row(page, 'sensor.resolution').locator('.problem').waitFor()
    await type(page, 'sensor.resolution', '4096')
    await expect.poll(() => field('sensor.resolution').inputValue()).toBe('4.096 km')
    expect(complaints).toEqual([])
    await context.close()
  })

  it('shows the unit of every number, and all digits where it is edited', async () => {
    const { page, context, complaints } = await openPage(here, width)
    const field = row(page, 'body.handle.damping').locator('input[type="text"]')
    await type(page, 'body.handle.damping', '0.0127828981167')
    await expect.poll(() => field.inputValue()).toBe('12.7828981167 mN s/m')
    await page.locator('h1').click()
    await expect.poll(() => field.inputValue()).toBe('12.78 mN s/m')
    await expect.poll(() => field.getAttribute('title')).toContain('12.7828981167 mN s/m')
    await settled(page)
    const answer = await nobody(page)
    await field.click()
    await expect.poll(() => field.inputValue()).toBe('12.7828981167 mN s/m')
    await page.keyboard.press('Enter')
    await page.locator('h1').click()
    await settled(page)
    await expect.poll(() => nobody(page)).toBe(answer)
    await expect.poll(() => page.getByRole('button', { name: 'Undo' }).isEnabled()).toBe(true)
    await page.getByRole('button', { name: 'Undo' }).click()
    await expect.poll(() => page.getByRole('button', { name: 'Undo' }).isEnabled()).toBe(false)
    expect(complaints).toEqual([])
    await context.close()
  })

  it('drags the wall on the bar and in the region, one step each', async () => {
    const { page, context, complaints } = await openPage(here, width)
    await withWall(page)
    await show(page, 'Wall')
    await settled(page)
    const stiffness = row(page, 'wall.stiffness').locator('input[type="text"]')
    const before = await stiffness.inputValue()
    for (const [panel, dx, dy] of [
      ['bar', -40, 0],
      ['region', 40, -60],
    ] as const) {
      const handle = page.locator(`#panel-${panel} .handle`)
      await handle.scrollIntoViewIfNeeded()
      const box = (await handle.locator('.reach').boundingBox())!
      const [x, y] = [box.x + box.width / 2, box.y + box.height / 2]
      await page.mouse.move(x, y)
      await page.mouse.down()
      for (let i = 1; i <= 8; ++i) await page.mouse.move(x + (dx * i) / 8, y + (dy * i) / 8)
      await page.mouse.up()
      await expect.poll(() => stiffness.inputValue(), { message: panel }).not.toBe(before)
      await page.getByRole('button', { name: 'Undo' }).click()
      await expect.poll(() => stiffness.inputValue(), { message: panel }).toBe(before)
    }
    // The same by keys.
    await page.locator('#panel-region .handle').focus()
    await page.keyboard.press('ArrowRight')
    await page.keyboard.press('Shift+ArrowDown')
    await expect.poll(() => row(page, 'wall.damping').locator('input[type="text"]').inputValue()).not.toBe('0 N s/m')
    await expect.poll(() => stiffness.inputValue()).not.toBe(before)
    await settled(page)
    await expect.poll(() => page.locator('[data-answer="wall"]').innerText()).toContain('stable')
    expect(complaints).toEqual([])
    await context.close()
  })

  it('says an error at its field, and gives no number', async () => {
    const { page, context } = await openPage(here, width)
    await type(page, 'body.motor.mass', '-1')
    await row(page, 'body.motor.mass').locator('.problem').waitFor()
    await expect.poll(() => row(page, 'body.motor.mass').locator('input[type="text"]').getAttribute('aria-invalid')).toBe('true')
    await expect.poll(() => page.locator('[data-answer="nobody"]').count()).toBe(0)
    await type(page, 'body.motor.mass', '3 N')
    await page.waitForFunction(() =>
      /no unit of a mass/.test(document.querySelector('[data-key="body.motor.mass"] .problem')?.textContent ?? ''),
    )
    await type(page, 'body.motor.mass', '0,3')
    await page.waitForFunction(() =>
      /has a comma; the decimal mark is a point/.test(document.querySelector('[data-key="body.motor.mass"] .problem')?.textContent ?? ''),
    )
    await expect.poll(() => row(page, 'body.motor.mass').locator('input[type="text"]').inputValue()).toBe('0,3')
    for (let i = 0; i < 3; ++i) await page.keyboard.press('Control+z')
    await page.waitForSelector('[data-answer="nobody"]')
    await expect.poll(() => nobody(page)).toBe('8.849 kN/m')
    await context.close()
  })

  it('shares all of it in the address', async () => {
    const { page, context } = await openPage(here, width)
    await type(page, 'link.0.stiffness', '65.4321 kN/m')
    await row(page, 'body.handle.mass').getByRole('button', { name: /Lock/ }).click()
    await page.getByRole('button', { name: 'Pin', exact: true }).click()
    await type(page, 'loop.delay', '1.5e-4')
    await settled(page)
    const [answer, hash] = [await nobody(page), await addressOf(page)]
    expect(hash.length).toBeLessThanOrEqual(2048 + 3)
    const again = await openPage(here, width, hash)
    await expect.poll(() => nobody(again.page)).toBe(answer)
    await expect.poll(() => row(again.page, 'body.handle.mass').locator('input[type="text"]').isDisabled()).toBe(true)
    await settled(again.page)
    await expect.poll(() => again.page.locator('#panel-bar').innerText()).toContain('design 1')
    await again.context.close()
    await context.close()
  })

  // Colours do not hang on the width: the dark ones are looked at once.
  it.each(width > 1000 ? (['light', 'dark'] as const) : (['light'] as const))(
    'is usable by all: no violation on any tab, %s',
    async (scheme) => {
      const { page, context, complaints } = await openPage(here, width, '', scheme)
      await withWall(page)
      await askAll(page)
      await page.getByRole('button', { name: 'Pin', exact: true }).click()
      await show(page, 'Frequency')
      await page.getByRole('button', { name: 'Table of Bode magnitude' }).click()
      await show(page, 'Recording')
      await page.getByLabel(/choose it/).setInputFiles(`${project}/recordings/locked_chirp.csv`)
      await page.getByRole('button', { name: 'Fit', exact: true }).click()
      await page.getByRole('button', { name: 'Use this device' }).waitFor()
      await settled(page)
      await page.evaluate(axe.source)
      const look = async (tab: string): Promise<void> => {
        expect(await violations(page), `${tab}, ${scheme}`).toEqual([])
        await expect
          .poll(() => page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth))
          .toBeLessThanOrEqual(0)
      }
      await onEachTab(page, look)
      await page.getByRole('button', { name: 'New, open' }).click()
      await look('the menu')
      await page.keyboard.press('Escape')
      await toDevice(page)
      await look('the device')
      expect(complaints).toEqual([])
      await context.close()
    },
  )

  it('goes from a recording to a device', async () => {
    const { page, context, complaints } = await openPage(here, width)
    let fits = 0
    page.on('request', (request) => (fits += request.url().endsWith('/identify') ? 1 : 0))
    await runPalette(page, 'show: from a recording')
    await page.getByLabel(/choose it/).setInputFiles(`${project}/recordings/locked_chirp.csv`)
    await page.getByLabel('Fit').selectOption('device')
    await page.getByLabel('handle', { exact: true }).check()
    await page.getByRole('button', { name: 'Fit', exact: true }).click()
    await page.getByRole('button', { name: 'Use this device' }).waitFor()
    await settled(page)
    await page.getByRole('button', { name: 'Use this device' }).click()
    await page.locator('[data-answer="nobody-interval"]').waitFor()
    const fitted = documentOf(
      'identify',
      'recordings/locked_chirp.csv',
      '--force',
      'force',
      '--position',
      'position',
      '--structure',
      'devices/lhifam.toml',
      '--locked',
      'handle',
    )
    await settled(page)
    expect(fits).toBe(1)
    await expect.poll(() => nobody(page)).toBe(`${Number((Number(fitted.critical_stiffness) / 1000).toPrecision(4))} kN/m`)
    expect(complaints).toEqual([])
    await context.close()
  })
}
