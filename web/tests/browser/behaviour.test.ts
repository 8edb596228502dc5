// What a hand expects: text that is undone as text, a mistake that takes no picture away, words that do what they say.
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs'
import { tmpdir } from 'node:os'
import { afterAll, expect, it } from 'vitest'
import { documentOf, nobody, openPage, place, row, runPalette, settled, show, type } from './program'

const folder = mkdtempSync(`${tmpdir()}/zwidth-`)
const here = place('devices/lhifam.toml')
afterAll(() => rmSync(folder, { recursive: true }))

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

it('keeps the picture beside a mistake, dimmed, names the number and leads to it', async () => {
  const { page, context } = await openPage(here, 1280)
  await settled(page)
  await type(page, 'body.motor.mass', '-1')
  await page.locator('.answer .problem', { hasText: 'Body “motor”: mass' }).waitFor()
  await expect.poll(() => page.locator('#body-region.stale svg path.curve').count()).toBeGreaterThan(0)
  await expect.poll(() => page.locator('#panel-bar.stale svg').count()).toBe(1)
  await expect.poll(() => page.locator('#panel-region .late').innerText()).toBe('of the numbers before the error')
  expect(await page.locator('[data-answer="nobody"]').count()).toBe(0)
  await page.locator('h1').click()
  await page.locator('.answer').getByRole('button', { name: 'Go to it' }).click()
  await expect.poll(() => page.locator('[data-key]:has(input:focus)').getAttribute('data-key')).toBe('body.motor.mass')
  await page.keyboard.type('0.3')
  await page.keyboard.press('Enter')
  await settled(page)
  await expect.poll(() => page.locator('.stale').count()).toBe(0)
  expect(await nobody(page)).toBe('8.849 kN/m')
  await context.close()
})

it('takes the wall recommended where it says so', async () => {
  const { page, context, complaints } = await openPage(here, 1280)
  await show(page, 'Time')
  await page.getByRole('button', { name: 'take the one recommended' }).click()
  await page.waitForSelector('[data-answer="wall"]')
  await settled(page)
  const { wall } = documentOf('design', 'devices/lhifam.toml', '--recommend') as { wall: { stiffness: number; damping: number } }
  await show(page, 'File')
  const text = await page.locator('#toml').inputValue()
  expect(text).toContain(`stiffness = ${wall.stiffness}`)
  expect(text).toContain(`damping = ${wall.damping}`)
  expect(complaints).toEqual([])
  await context.close()
})

it('finds in its commands what people call them', async () => {
  const { page, context, complaints } = await openPage(here, 1280)
  for (const [words, first] of [
    ['bode', 'Show: Frequency response'],
    ['simulate', 'Show: The wall hit in time'],
    ['identify', 'Show: From a recording to a device'],
    ['dark', 'Colours: dark'],
    ['theme light', 'Colours: light'],
    ['open file', 'Open a file'],
    ['share', 'Copy a link to this design'],
    ['keys', 'Help'],
  ] as const) {
    await page.keyboard.press('Control+k')
    await page.getByRole('combobox', { name: 'What to do?' }).waitFor()
    await page.keyboard.type(words)
    await expect.poll(() => page.locator('#action-0').innerText(), words).toContain(first)
    await page.keyboard.press('Escape')
    await page.getByRole('combobox', { name: 'What to do?' }).waitFor({ state: 'hidden' })
  }
  await runPalette(page, 'bode')
  await expect.poll(() => page.locator('#panel-bode').isVisible()).toBe(true)
  expect(complaints).toEqual([])
  await context.close()
})

it('refuses a file that is no text, and keeps the device', async () => {
  const { page, context, complaints } = await openPage(here, 1280)
  for (const [name, bytes] of [
    ['zeros.toml', [0x61, 0, 0x62]],
    ['picture.toml', [0x89, 0x50, 0x4e, 0x47, 0xff]],
  ] as const) {
    writeFileSync(`${folder}/${name}`, Uint8Array.from(bytes))
    await page.locator('#open-file').setInputFiles(`${folder}/${name}`)
    await page.locator('.notices .problem', { hasText: `${name} is no text` }).waitFor()
    expect(await nobody(page)).toBe('8.849 kN/m')
    expect(await page.getByRole('button', { name: 'Undo' }).isEnabled()).toBe(false)
  }
  await page.locator('.notices').getByRole('button', { name: 'Dismiss' }).click()
  await expect.poll(() => page.locator('.notices .problem').count()).toBe(0)
  expect(complaints).toEqual([])
  await context.close()
})

it('draws the wall in the colour of its verdict, on the bar and in the region', async () => {
  const { page, context, complaints } = await openPage(here, 1280)
  for (const [stiffness, look] of [
    ['3 kN/m', 'for-anyone'],
    ['7 kN/m', 'alone-only'],
    ['20 kN/m', 'unstable'],
  ] as const) {
    await type(page, 'wall.stiffness', stiffness)
    await settled(page)
    for (const panel of ['bar', 'region'])
      await expect.poll(() => page.locator(`#panel-${panel} .handle`).getAttribute('class'), { message: panel }).toContain(look)
  }
  expect(complaints).toEqual([])
  await context.close()
})

it('leaves a slider where it was let go, and gives it another range at an end', async () => {
  const { page, context, complaints } = await openPage(here, 1280)
  const slider = row(page, 'body.motor.mass').locator('input[type="range"]')
  const slide = (to: number): Promise<void> =>
    slider.evaluate((each: HTMLInputElement, at) => {
      each.value = String(at)
      each.dispatchEvent(new Event('input', { bubbles: true }))
      each.dispatchEvent(new Event('change', { bubbles: true }))
    }, to)
  await slide(650)
  await expect.poll(async () => Math.abs(Number(await slider.inputValue()) - 650)).toBeLessThan(3)
  await slide(1000)
  await expect.poll(async () => Number(await slider.inputValue())).toBeLessThan(500)
  expect(complaints).toEqual([])
  await context.close()
})

it('offers the unit that the name of a column states', async () => {
  const { page, context, complaints } = await openPage(here, 1280)
  writeFileSync(`${folder}/knob.csv`, 'time_s,torque [mNm],angle (deg)\n0,0,0\n0.001,1,0\n0.002,0,1e-3\n')
  await show(page, 'Recording')
  await page.getByLabel(/choose it/).setInputFiles(`${folder}/knob.csv`)
  await page.getByRole('button', { name: 'Take 1 mN m, as its name says' }).click()
  await page.getByRole('button', { name: 'Take 1 deg, as its name says' }).click()
  await expect.poll(() => page.getByLabel('One unit of the force is').inputValue()).toBe('1 mN m')
  await expect.poll(() => page.getByLabel('One unit of the position is').inputValue()).toBe('1 deg')
  expect(complaints).toEqual([])
  await context.close()
})
