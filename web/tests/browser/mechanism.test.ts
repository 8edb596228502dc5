// A device of a mechanism: its pose, its wall's normal, the map of its workspace, and files that are missing.
import axe from 'axe-core'
import { readFileSync } from 'node:fs'
import type { Page } from 'playwright-core'
import { expect, it } from 'vitest'
import { documentOf, nobody, openPage, place, project, row, runPalette, settled, type } from './program'

const file = 'devices/mechanisms/planar_arm.toml'
const here = place(file)
const wordOf = (stiffness: number): string =>
  stiffness < 1000 ? `${Number(stiffness.toPrecision(4))} N/m` : `${Number(stiffness.toPrecision(4)) / 1000} kN/m`
const limit = (...sets: string[]): string =>
  wordOf(Number(documentOf('analyze', file, ...sets.flatMap((each) => ['--set', each])).critical_stiffness))
const openMap = async (page: Page): Promise<void> => {
  await runPalette(page, 'show: where in the workspace')
  await page.getByLabel('Poses').fill('shoulder=-60:60:5 deg,elbow=20:150:5 deg')
  await page.getByLabel('Directions').fill('6')
  await page.getByLabel('Directions').press('Enter')
  await page.locator('[data-workspace="least"]').waitFor()
  await settled(page)
}

it('shows the device that the program was started with, at its pose', async () => {
  const { page, context, complaints } = await openPage(here, 1280)
  expect(await page.locator('h1').innerText()).toBe('Planar arm, two cables')
  expect(await nobody(page)).toBe(limit())
  const elbow = row(page, 'mechanism.pose.elbow').locator('input[type="text"]')
  await type(page, 'mechanism.pose.elbow', '40 deg')
  await expect.poll(() => nobody(page)).toBe(limit('mechanism.pose.elbow="40 deg"'))
  await elbow.press('ArrowUp')
  await expect.poll(() => elbow.inputValue()).toMatch(/^41\.3 deg$/)
  const slider = row(page, 'mechanism.pose.shoulder').locator('input[type="range"]')
  await slider.focus()
  await slider.press('Home')
  await expect.poll(() => row(page, 'mechanism.pose.shoulder').locator('input[type="text"]').inputValue()).toContain('-1.571 rad')
  await settled(page)
  expect(await nobody(page)).toBe(limit('mechanism.pose.elbow="41.3 deg"', 'mechanism.pose.shoulder=-1.571'))
  expect(complaints).toEqual([])
  await context.close()
})

it('turns the wall, to a point too, and draws nothing that is not known', async () => {
  const { page, context, complaints } = await openPage(here, 1280)
  await page.getByRole('slider', { name: /normal, turned/ }).focus()
  await page.keyboard.press('End')
  await expect.poll(() => page.getByLabel('y of the normal').inputValue()).toBe('1')
  await expect.poll(() => nobody(page)).toBe(limit('mechanism.normal=[0,1,0]'))
  await page.getByLabel('z of the normal').fill('1')
  await page.getByLabel('z of the normal').press('Enter')
  await page.getByLabel('y of the normal').fill('0')
  await page.getByLabel('y of the normal').press('Enter')
  await page.locator('.schematic .problem').waitFor()
  expect(await page.locator('[data-answer="nobody"]').count()).toBe(0)
  for (let i = 0; i < 2; ++i) await page.keyboard.press('Control+z')
  await page.getByLabel(/in every direction at once/).check()
  await expect.poll(() => nobody(page)).toBe(limit('mechanism.normal=all'))
  await expect.poll(() => page.locator('[data-answer="any-user"]').innerText()).toContain('at least 231.2 N/m')
  await expect.poll(() => page.locator('[data-answer="limited-by"]').innerText()).toContain('shakes along')
  await settled(page)
  const words = await page.locator('#panel-bar svg text').allTextContents()
  expect(words).toContain('stable for anyone')
  expect(words).not.toContain('unstable')
  expect(await page.locator('[data-answer="wall"]').innerText()).not.toContain('none')
  expect(complaints).toEqual([])
  await context.close()
})

it.each([
  [1280, 'light'],
  [390, 'dark'],
] as const)('maps the workspace, %i pixels wide, %s', async (width, scheme) => {
  const { page, context, complaints } = await openPage(here, width, '', scheme)
  await openMap(page)
  const asked = documentOf('workspace', file, '--poses', 'shoulder=-60:60:5 deg,elbow=20:150:5 deg', '--normals', '6')
  const least = asked.least_any_user as { value: number; pose: number[] }
  await expect.poll(() => page.locator('[data-workspace="least"]').innerText()).toContain(wordOf(least.value))
  expect(await page.locator('svg.map circle:not([class])').count()).toBe(25)
  const found = await page.evaluate(`${axe.source}; axe.run()`)
  expect((found as axe.AxeResults).violations.map(({ id, nodes }) => [id, nodes.map(({ html }) => html)])).toEqual([])
  expect(await page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth)).toBeLessThanOrEqual(0)
  await page.getByRole('button', { name: 'Go there' }).first().click()
  await settled(page)
  const anyUser = (await page.locator('[data-answer="any-user"]').innerText()).replace(' N/m', '')
  expect(Number(anyUser) / least.value).toBeCloseTo(1, 2)
  expect(complaints).toEqual([])
  await context.close()
})

it('asks for the file that a device names, and takes both at once', async () => {
  const { page, context } = await openPage(here, 1280)
  const [toml, xml] = [`${project}/${file}`, `${project}/devices/mechanisms/planar_arm.xml`]
  await page.locator('#open-file').setInputFiles(toml)
  await page.locator('[data-mechanism="missing"]').waitFor()
  expect(await page.locator('[data-answer="nobody"]').count()).toBe(0)
  await page.getByLabel('Choose planar_arm.xml').setInputFiles(xml)
  await expect.poll(() => nobody(page)).toBe(limit())
  await page.locator('#open-file').setInputFiles([toml, xml])
  await settled(page)
  expect(await nobody(page)).toBe(limit())
  // A mechanism alone is a device to begin with, whose period is assumed.
  await page.locator('#open-file').setInputFiles({ name: 'my arm.xml', mimeType: 'text/xml', buffer: readFileSync(xml) })
  await expect.poll(() => page.locator('h1').innerText()).toBe('my arm')
  await page.locator('[data-answer="assumed"]').waitFor()
  await context.close()
})
