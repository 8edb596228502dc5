// The damper in a loop of its own: added, changed and taken out again.
import { expect, it } from 'vitest'
import { say } from '../../src/model/decimal'
import { askAll, documentOf, nobody, onEachTab, openPage, place, row, runPalette, settled, show, toDevice, type } from './program'

const here = place('devices/lhifam.toml')
const limitOf = (...sets: string[]): string =>
  say(Number(documentOf('analyze', 'devices/lhifam.toml', ...sets.flatMap((each) => ['--set', each])).critical_stiffness), 'N/m')

it.each([1280, 390])('runs the damper at a rate of its own, and in one loop again, %i pixels wide', async (width) => {
  const { page, complaints } = await openPage(here, width)
  await type(page, 'wall.damping', '200')
  await expect.poll(() => nobody(page)).toBe('187.2 kN/m')
  const group = page.locator('[id="group-loop.damper"]')
  const file = (): Promise<string> => page.locator('#toml').inputValue()
  const before = await file()
  await group.getByRole('button', { name: 'Damper’s own loop (none)' }).click()
  await group.getByRole('button', { name: 'Add it, ten times as fast' }).click()
  await expect.poll(() => nobody(page)).toBe('500.7 kN/m')
  const period = row(page, 'loop.damper.sampling_period').locator('input[type="text"]')
  await expect.poll(() => period.inputValue()).toBe('100 µs')
  await expect.poll(() => page.getByRole('button', { name: 'Damper’s own loop: damper every 100 µs' }).count()).toBe(1)
  expect(limitOf('wall.damping=200', 'loop.damper.sampling_period=1e-4')).toBe('500.7 kN/m')

  // Its delay is the loop's until it has its own, if only 0.
  await type(page, 'loop.delay', '0.3 ms')
  await expect.poll(() => nobody(page)).toBe(limitOf('wall.damping=200', 'loop.damper.sampling_period=1e-4', 'loop.delay=3e-4'))
  await type(page, 'loop.damper.delay', '0')
  await expect
    .poll(() => nobody(page))
    .toBe(limitOf('wall.damping=200', 'loop.damper.sampling_period=1e-4', 'loop.delay=3e-4', 'loop.damper.delay=0'))

  // A period that does not fit is refused with one that does; keys step to those alone.
  await type(page, 'loop.damper.sampling_period', '0.3 ms')
  await row(page, 'loop.damper.sampling_period').getByRole('button', { name: /^Take/ }).click()
  await expect.poll(() => period.inputValue()).toBe('333.3 µs')
  await period.press('ArrowUp')
  await expect.poll(() => period.inputValue()).toBe('500 µs')

  // Every panel answers or says why it does not.
  await askAll(page, ['Time', 'Frequency'])
  await onEachTab(page, async () => {})
  await toDevice(page)
  expect(await page.getByText('This panel failed').count()).toBe(0)
  const told = (await page.locator('.panel .panel-body > .problem').allTextContents()).map((each) => each.trim()).filter(Boolean)
  expect(told.filter((each) => !/runs the damper (in a loop of its own|apart)/.test(each))).toEqual([])

  await group.getByRole('button', { name: 'Take it out' }).click()
  await type(page, 'loop.delay', '0')
  await expect.poll(() => nobody(page)).toBe('187.2 kN/m')
  await expect.poll(file).not.toContain('damper')
  await page.keyboard.press('Control+z')
  await page.keyboard.press('Control+z')
  await expect.poll(file).toContain('[loop.damper]')
  expect(before).not.toContain('loop.damper')
  await settled(page)
  expect(complaints).toEqual([])
  await page.context().close()
})

it('draws the region of one loop for both beside it', async () => {
  const { page, complaints } = await openPage(here, 1280)
  await runPalette(page, 'go to own loop: sampling period')
  await page.keyboard.type('0.1 ms')
  await page.keyboard.press('Enter')
  await show(page, 'Wall')
  await page.locator('#body-region', { hasText: 'one loop for both, nobody holding' }).waitFor()
  await page.locator('#body-region', { hasText: /damper’s own loop gives [\d.]+ times that/ }).waitFor()
  await type(page, 'loop.damper.sampling_period', '')
  await page.locator('#body-region', { hasText: 'one loop for both' }).waitFor({ state: 'detached' })
  expect(complaints).toEqual([])
  await page.context().close()
})
