// What the panels state and do, beside the program's documents.
import type { Browser } from 'playwright-core'
import { afterAll, beforeAll, expect, it } from 'vitest'
import { documentOf, openBrowser, openPage, row, runPalette, type Served, serve, settled, type } from './program'

let served: Served
let browser: Browser
beforeAll(async () => {
  served = await serve('devices/quanser_torsion.toml')
  browser = await openBrowser()
})
afterAll(async () => {
  await browser?.close()
  await served?.stop()
})

interface Wall {
  stiffness: number
  damping: number
  filters: { frequency_hz: number; damping_ratio: number; depth: number }[]
}

it('takes the wall recommended with its notch in one step', async () => {
  const { page, context, complaints } = await openPage(browser, served, 1280)
  await runPalette(page, 'show: which wall')
  await page.getByRole('button', { name: 'Use this wall: recommended' }).click()
  await settled(page)
  const asked = documentOf('design', 'devices/quanser_torsion.toml', '--recommend') as unknown as { wall: Wall; margins: { gain_margin_db: number; phase_margin_rad: number } }
  await runPalette(page, 'show: device file')
  const toml = await page.locator('#toml').inputValue()
  const notch = asked.wall.filters[0]!
  for (const [key, value] of Object.entries({ stiffness: asked.wall.stiffness, damping: asked.wall.damping, frequency_hz: notch.frequency_hz, damping_ratio: notch.damping_ratio, depth: notch.depth })) {
    expect(toml).toMatch(new RegExp(`\n${key} = ${String(value).replace('.', '\\.')}\n`))
  }
  const margin = `${Number(asked.margins.gain_margin_db.toPrecision(3))} dB`
  expect(await page.locator('[data-answer="wall"]').innerText()).toContain(margin)
  await page.getByRole('button', { name: 'Undo' }).click()
  expect(await page.locator('#toml').inputValue()).not.toContain('notch')
  expect(await row(page, 'wall.stiffness').locator('input[type="text"]').inputValue()).not.toContain(String(asked.wall.stiffness))
  expect(complaints).toEqual([])
  await context.close()
})
