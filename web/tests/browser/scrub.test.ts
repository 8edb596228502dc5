// A number is dragged by its name, its slider keeps its range, and a unit of another kind is asked about.
import { expect, it } from 'vitest'
import { openPage, place, row, settled, type } from './program'

const here = place('devices/capstan_paddle.toml')

it('drags a number by its name, with Shift finely, as one step', async () => {
  const { page, context, complaints } = await openPage(here, 1280)
  await type(page, 'loop.delay', '1e-3')
  const field = row(page, 'loop.delay').locator('input[type="text"]')
  const value = async (): Promise<number> => Number.parseFloat(await field.inputValue())
  const name = row(page, 'loop.delay').locator('label')
  await name.scrollIntoViewIfNeeded()
  const box = (await name.boundingBox())!
  const [x, y] = [box.x + 10, box.y + box.height / 2]
  await page.mouse.move(x, y)
  await page.mouse.down()
  await page.mouse.move(x + 40, y, { steps: 8 })
  await page.mouse.up()
  await expect.poll(value).toBeCloseTo(Math.exp(0.4), 2)
  await page.keyboard.press('Control+z')
  await expect.poll(value).toBe(1)
  await page.keyboard.down('Shift')
  await page.mouse.move(x, y)
  await page.mouse.down()
  await page.mouse.move(x + 40, y, { steps: 8 })
  await page.mouse.up()
  await page.keyboard.up('Shift')
  await expect.poll(value).toBeCloseTo(Math.exp(0.04), 3)
  // A press that does not move goes to the number.
  await page.evaluate(() => (document.activeElement as HTMLElement).blur())
  await name.click()
  await expect.poll(() => field.evaluate((each) => each === document.activeElement)).toBe(true)
  expect(complaints).toEqual([])
  await context.close()
})

it('keeps the range of a slider as its number passes a power of ten', async () => {
  const { page, context, complaints } = await openPage(here, 1280)
  await type(page, 'loop.delay', '0.95e-3')
  const slider = row(page, 'loop.delay').locator('input[type="range"]')
  const before = Number(await slider.inputValue())
  await type(page, 'loop.delay', '1.05e-3')
  await expect.poll(async () => Number(await slider.inputValue()) - before).toBeGreaterThan(0)
  expect(Number(await slider.inputValue()) - before).toBeLessThan(30)
  expect(complaints).toEqual([])
  await context.close()
})

it('asks about a stiffness in a field of a torque', async () => {
  const { page, context, complaints } = await openPage(here, 1280)
  const force = row(page, 'actuator.force_limit')
  const before = await force.locator('input[type="text"]').inputValue()
  await type(page, 'actuator.force_limit', '5 N m/rad')
  await force.getByRole('button', { name: 'Leave it as it was' }).click()
  await expect.poll(() => force.locator('input[type="text"]').inputValue()).toBe(before)
  await type(page, 'actuator.force_limit', '5 mN m/deg')
  await force.getByRole('button', { name: 'Take 5 mN m' }).click()
  await settled(page)
  await expect.poll(() => force.locator('input[type="text"]').inputValue()).toBe('5 mN m')
  await expect.poll(() => force.locator('.problem').count()).toBe(0)
  await type(page, 'wall.stiffness', '0.4 N m')
  await row(page, 'wall.stiffness').getByRole('button', { name: 'Take 0.4 N m/deg' }).click()
  await expect.poll(() => row(page, 'wall.stiffness').locator('input[type="text"]').inputValue()).toBe('0.4 N m/deg')
  expect(complaints).toEqual([])
  await context.close()
})
