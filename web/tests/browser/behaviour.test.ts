// What a hand expects: text that is undone as text, a mistake that takes no picture away, words that do what they say.
import { expect, it } from 'vitest'
import { openPage, place, row, type } from './program'

const here = place('devices/lhifam.toml')

it('undoes text that is not yet read as text, and selects what Enter read', async () => {
  const { page, context, complaints } = await openPage(here, 1280)
  const mass = row(page, 'body.motor.mass').locator('input[type="text"]')
  await type(page, 'body.motor.damping', '0.3')
  await mass.click()
  await page.keyboard.type('0.7')
  await page.keyboard.press('Control+z')
  await expect.poll(() => mass.inputValue()).not.toBe('0.7')
  await expect.poll(() => row(page, 'body.motor.damping').locator('input[type="text"]').inputValue()).toBe('0.3 N s/m')
  await page.keyboard.press('Escape')
  await page.keyboard.type('0.4')
  await page.keyboard.press('Enter')
  await page.keyboard.type('0.5') // in its place
  await page.keyboard.press('Enter')
  await expect.poll(() => mass.inputValue()).toBe('0.5 kg')
  await page.keyboard.press('Control+z')
  await expect.poll(() => mass.inputValue()).toBe('0.4 kg')
  expect(complaints).toEqual([])
  await context.close()
})
