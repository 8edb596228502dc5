// Links: opened, pasted into the tab, followed back, broken.
import type { Page } from 'playwright-core'
import { expect, it } from 'vitest'
import { addressOf, nobody, openPage, place, row, settled, type } from './program'

const here = place('devices/lhifam.toml')

const stiffness = (page: Page): Promise<string> => row(page, 'link.0.stiffness').locator('input[type="text"]').inputValue()

it('follows a link pasted into its tab, and Back, as steps to undo', async () => {
  const { page, context, complaints } = await openPage(here, 1280)
  const first = await addressOf(page)
  await type(page, 'link.0.stiffness', '70000')
  await settled(page)
  const answer = await nobody(page)
  const changed = await addressOf(page)
  await page.keyboard.press('Control+z')
  expect(await addressOf(page)).toBe(first)

  await page.evaluate((hash) => (location.hash = hash), changed)
  await expect.poll(() => stiffness(page)).toBe('70 kN/m')
  await settled(page)
  await expect.poll(() => nobody(page)).toBe(answer)
  await page.getByRole('button', { name: 'Undo' }).click()
  await expect.poll(() => stiffness(page)).toBe('79.5 kN/m')
  await page.getByRole('button', { name: 'Redo' }).click()
  await expect.poll(() => stiffness(page)).toBe('70 kN/m')
  await addressOf(page)
  await page.goBack()
  await expect.poll(() => stiffness(page)).toBe('79.5 kN/m')
  await page.goForward()
  await expect.poll(() => stiffness(page)).toBe('70 kN/m')
  expect(complaints).toEqual([])
  await context.close()
})

it('says what is wrong with a link, and keeps what it shows', async () => {
  const { page, context, complaints } = await openPage(here, 1280)
  await type(page, 'link.0.stiffness', '70000')
  const hash = await addressOf(page)
  const at = hash.length - 10
  for (const [broken, why] of [
    [hash.slice(0, at) + (hash[at] === 'A' ? 'B' : 'A') + hash.slice(at + 1), /changed or cut off/],
    [hash.slice(0, -5), /changed or cut off/],
    ['#d=', /changed or cut off/],
    [hash.replace('#d=b', '#d=a'), /older version/],
  ] as const) {
    await page.evaluate((each) => (location.hash = each), broken)
    await expect.poll(() => page.locator('.notices .problem').allInnerTexts(), broken).toEqual([expect.stringMatching(why)])
    await expect.poll(() => stiffness(page)).toBe('70 kN/m')
    const opened = await openPage(here, 1280, broken)
    await expect.poll(() => opened.page.locator('.notices .problem').innerText()).toMatch(why)
    await expect.poll(() => stiffness(opened.page)).toBe('79.5 kN/m')
    await opened.context.close()
  }
  await page.evaluate((each) => (location.hash = each), hash)
  await expect.poll(() => page.locator('.notices .problem').count()).toBe(0)
  expect(complaints).toEqual([])
  await context.close()
})
