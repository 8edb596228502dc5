// The wall hit in time; and a device of many parts.
import { expect, it } from 'vitest'
import { say } from '../../src/model/decimal'
import { documentOf, openPage, place, settled, show, type } from './program'

const here = place('devices/lhifam.toml')

it('hits the wall as fast as it is told, and draws its surface', async () => {
  const { page, context, complaints } = await openPage(here, 1280)
  await type(page, 'wall.stiffness', '3000')
  await show(page, 'Time')
  await settled(page)
  await page.getByLabel(/^Speed of approach/).fill('0.05')
  await page.keyboard.press('Enter')
  await settled(page)
  const hit = documentOf(
    'simulate',
    'devices/lhifam.toml',
    '--set',
    'wall.stiffness=3000',
    '--wall-position',
    '0.0001',
    '--start-velocity',
    '0.05',
  ) as { peak_penetration: number }
  await expect.poll(() => page.locator('[data-time="deepest"]').innerText()).toBe(say(hit.peak_penetration, 'm'))
  const figure = page.locator('svg[aria-label="Position over time"]')
  await expect.poll(() => figure.locator('line.level').count()).toBe(1)
  await expect.poll(() => figure.textContent()).toContain('surface of the wall')
  expect(complaints).toEqual([])
  await context.close()
})

it('lists the parts of a device with more bodies than can be drawn beside each other', async () => {
  const { page, context, complaints } = await openPage(here, 1280)
  await show(page, 'File')
  const body = (i: number): string => `[[body]]\nname = "part ${i}"\nmass = ${1 + i}\ndamping = 1\n`
  const link = (i: number): string => `[[link]]\nbetween = ["part ${i}", "part ${i + 1}"]\nstiffness = 1e5\ndamping = 3\n`
  const all = [0, 1, 2, 3, 4, 5, 6, 7]
  await page
    .locator('#toml')
    .fill(`name = "train"\n${all.map(body).join('')}${all.slice(0, 7).map(link).join('')}[loop]\nsampling_period = 1e-3\n`)
  await page.locator('#toml').blur()
  await page.getByRole('heading', { name: 'train' }).waitFor()
  const list = page.getByRole('region', { name: 'Parts of the device' })
  await expect.poll(() => list.locator('tbody tr').count()).toBe(8)
  await list.getByRole('button', { name: 'part 5', exact: true }).click()
  await expect
    .poll(() => page.evaluate(() => document.activeElement?.closest('[data-key]')?.getAttribute('data-key')))
    .toBe('body.part 5.mass')
  expect(complaints).toEqual([])
  await context.close()
})
