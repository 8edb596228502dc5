// Figures are made larger, moved and read together.
import type { Page } from 'playwright-core'
import { expect, it } from 'vitest'
import { openPage, place, settled, show, type } from './program'

const here = place('devices/lhifam.toml')
const figure = (page: Page, name: string) => page.locator(`svg[aria-label="${name}"]`)
/** The first and last number on the axis below. */
const axis = (page: Page, name: string): Promise<string> =>
  figure(page, name)
    .locator('text.tick[text-anchor="middle"]')
    .evaluateAll((all) => `${all[0]?.textContent} ${all.at(-1)?.textContent}`)

it('makes a figure larger by the wheel, with the one beside it, moves it by a drag, and brings it back', async () => {
  const { page, context, complaints } = await openPage(here, 1280)
  await show(page, 'Frequency')
  await settled(page)
  const [all, phase] = [await axis(page, 'Bode magnitude'), await axis(page, 'Bode phase')]
  const box = (await figure(page, 'Bode magnitude').boundingBox())!
  await page.mouse.move(box.x + box.width / 2, box.y + 80)
  await page.mouse.wheel(0, -200)
  await page.mouse.wheel(0, -200)
  await expect.poll(() => axis(page, 'Bode magnitude')).not.toBe(all)
  const near = await axis(page, 'Bode magnitude')
  expect(await axis(page, 'Bode phase')).toBe(near)
  await page.mouse.down()
  await page.mouse.move(box.x + box.width / 2 + 150, box.y + 80, { steps: 5 })
  await page.mouse.up()
  await expect.poll(() => axis(page, 'Bode magnitude')).not.toBe(near)
  await page.mouse.dblclick(box.x + box.width / 2, box.y + 80)
  await expect.poll(() => axis(page, 'Bode magnitude')).toBe(all)
  await expect.poll(() => axis(page, 'Bode phase')).toBe(phase)
  // All of it is there: the wheel scrolls the page, and goes on with it.
  await page.mouse.wheel(0, 60)
  await expect.poll(() => page.locator('#panels').evaluate((each) => each.scrollTop)).toBeGreaterThan(0)
  expect(await axis(page, 'Bode magnitude')).toBe(all)
  expect(complaints).toEqual([])
  await context.close()
})

it('does the same by keys', async () => {
  const { page, context, complaints } = await openPage(here, 1280)
  await type(page, 'wall.stiffness', '3 kN/m')
  await show(page, 'Time')
  await settled(page)
  const all = await axis(page, 'Position over time')
  await figure(page, 'Position over time').focus()
  await page.keyboard.press('+')
  await page.keyboard.press('+')
  await expect.poll(() => axis(page, 'Position over time')).not.toBe(all)
  await expect.poll(() => axis(page, 'Force over time')).not.toBe(all)
  const near = await axis(page, 'Position over time')
  await page.keyboard.press('ArrowRight')
  await page.keyboard.press('ArrowRight')
  await expect.poll(() => axis(page, 'Position over time')).not.toBe(near)
  await page.keyboard.press('0')
  await expect.poll(() => axis(page, 'Position over time')).toBe(all)
  await page.keyboard.press('+')
  await page.getByRole('button', { name: 'Show all of Force over time' }).click()
  await expect.poll(() => axis(page, 'Position over time')).toBe(all)
  expect(complaints).toEqual([])
  await context.close()
})

it('has one cursor for the figures of an axis', async () => {
  const { page, context, complaints } = await openPage(here, 1280)
  await show(page, 'Frequency')
  await settled(page)
  const box = (await figure(page, 'Bode phase').boundingBox())!
  await page.mouse.move(box.x + 300, box.y + 60)
  const at = (name: string): Promise<string | null> => figure(page, name).locator('line.cursor').getAttribute('x1')
  await expect.poll(() => at('Bode magnitude')).toBe(await at('Bode phase'))
  const read = (name: string): Promise<string> =>
    page
      .locator('figure', { has: figure(page, name) })
      .locator('output')
      .innerText()
  expect(/^frequency [^:]*:/.exec(await read('Bode magnitude'))?.[0]).toBe(/^frequency [^:]*:/.exec(await read('Bode phase'))?.[0])
  await page.mouse.move(5, 5)
  await expect.poll(() => figure(page, 'Bode magnitude').locator('line.cursor').count()).toBe(0)
  expect(complaints).toEqual([])
  await context.close()
})

it('shows a wall near the origin where it can be dragged, in the colour of its verdict', async () => {
  const { page, context, complaints } = await openPage(here, 1280)
  await type(page, 'wall.stiffness', '3 kN/m')
  await settled(page)
  const region = figure(page, 'Stiff and damped walls')
  const knob = region.locator('.handle circle.knob')
  const where = async (): Promise<[number, number]> => {
    const [of, all] = [(await knob.boundingBox())!, (await region.boundingBox())!]
    return [of.x - all.x, all.y + all.height - of.y - of.height]
  }
  // Without damping it stands at the left end; with the stiffness above the axis.
  expect((await where())[1]).toBeGreaterThan(60)
  await type(page, 'wall.damping', '2')
  await settled(page)
  expect((await where())[0]).toBeGreaterThan(100)
  const colour = (): Promise<string> => knob.evaluate((each) => getComputedStyle(each).stroke)
  const good = await colour()
  await type(page, 'wall.damping', '0')
  await type(page, 'wall.stiffness', '60 kN/m')
  await settled(page)
  expect(await colour()).not.toBe(good)
  // In the middle of the region its axes are even.
  await type(page, 'wall.damping', '200')
  await settled(page)
  await expect.poll(() => axis(page, 'Stiff and damped walls')).toMatch(/^0 /)
  expect(complaints).toEqual([])
  await context.close()
})
