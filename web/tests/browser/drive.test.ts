// The drive of a rig: a table of the device file that no limit feels.
import { execFileSync } from 'node:child_process'
import { expect, it } from 'vitest'
import { nobody, openPage, place, program, row, settled, type } from './program'

const here = place('devices/lhifam.toml')

it.each([1280, 390])('is written with its units, judged at its fields, and taken out again, %i pixels wide', async (width) => {
  const { page, context, complaints } = await openPage(here, width)
  const text = (): Promise<string> => page.locator('#toml').inputValue()
  const [before, answer] = [await text(), await nobody(page)]
  await page.getByRole('button', { name: 'Drive of a rig' }).click()
  await type(page, 'driver.gear', '2')
  await row(page, 'driver.travel').locator('.problem', { hasText: 'must be given' }).waitFor()
  const given = { travel: '25 mm', sign: '-1', torque_constant: '50 mN m/A', torque_per_volt: '0.2', id: '3', command: 'K', baud: '921600' }
  for (const [key, value] of Object.entries(given)) await type(page, `driver.${key}`, value)
  await settled(page)
  await expect.poll(() => nobody(page)).toBe(answer)
  const device = JSON.parse(execFileSync(program, ['export', '-', '--format', 'json'], { input: await text(), encoding: 'utf8' })) as {
    device_file: { driver: unknown }
  }
  expect(device.device_file.driver).toEqual({
    travel: 0.025,
    gear: 2,
    sign: -1,
    force_sign: 1,
    torque_constant: 0.05,
    torque_per_volt: 0.2,
    id: 3,
    command: 'K',
    baud: 921600,
  })
  // What is no such drive is said at its field.
  for (const [key, value, said] of [
    ['sign', '3', 'must be 1'],
    ['gear', '2 m', 'no unit of a ratio'],
    ['command', 'MM', 'one letter'],
    ['baud', '12.5', 'whole number'],
  ] as const) {
    await type(page, `driver.${key}`, value)
    await row(page, `driver.${key}`).locator('.problem', { hasText: said }).waitFor()
    await page.keyboard.press('Control+z')
  }
  // A choice is not stepped; what is emptied is left out.
  const id = row(page, 'driver.id').locator('input[type="text"]')
  await id.press('ArrowUp')
  await expect.poll(() => id.inputValue()).toBe('3')
  await type(page, 'driver.id', '')
  await expect.poll(() => text()).not.toMatch(/^id =/m)
  await expect.poll(() => id.getAttribute('placeholder')).toBe('the firmware’s')
  await page.getByRole('button', { name: 'Take it out' }).click()
  await expect.poll(() => text()).not.toContain('driver')
  expect((await text()).trim()).toBe(before.trim())
  await page.getByRole('button', { name: 'Add a drive' }).click()
  await expect.poll(() => text()).toMatch(/\n\[driver\]\n/)
  expect(complaints).toEqual([])
  await context.close()
})
