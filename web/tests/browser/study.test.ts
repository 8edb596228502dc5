// Many units of a design, and the same by the command that is copied.
import { execFileSync } from 'node:child_process'
import { mkdtempSync, rmSync } from 'node:fs'
import { tmpdir } from 'node:os'
import { dirname } from 'node:path'
import axe from 'axe-core'
import { afterAll, expect, it } from 'vitest'
import { say } from '../../src/model/decimal'
import { addressOf, openPage, place, program, row, settled, show } from './program'

const folder = mkdtempSync(`${tmpdir()}/zwidth-`)
const here = place('devices/lhifam.toml')
afterAll(() => rmSync(folder, { recursive: true }))

it.each([1280, 390])('says what share of many units reaches a stiffness, and which is the worst, %i pixels wide', async (width) => {
  const { page, context, complaints } = await openPage(here, width)
  await show(page, 'Study')
  await page.getByRole('button', { name: 'Vary a number' }).click()
  await page.locator('#spread-key-0').selectOption('link.0.stiffness')
  await page.locator('#spread-a-0').fill('8 %')
  await page.keyboard.press('Tab')
  await page.getByRole('button', { name: 'Vary another number' }).click()
  await page.locator('#spread-key-1').selectOption('body.handle.damping')
  await page.locator('#spread-kind-1').selectOption('triangular')
  await page.getByText('still says not by how much').waitFor()
  await page.locator('#spread-a-1').fill('1.7')
  await page.keyboard.press('Tab')
  await page.locator('#spread-b-1').fill('5')
  await page.keyboard.press('Tab')
  await page.getByLabel(/^To reach, nobody holding/).fill('6 kN/m')
  await page.keyboard.press('Tab')
  await page.getByLabel('Units', { exact: true }).fill('300')
  await page.keyboard.press('Tab')
  await page.locator('[data-answer="yield"]').waitFor()
  await settled(page)
  await page.getByRole('button', { name: 'Copy as command: Many units of it' }).click()
  const command = (await page.evaluate(() => navigator.clipboard.readText())).replace('--samples 300', '--samples 300 --json')
  const study = JSON.parse(
    execFileSync('bash', ['-c', command], {
      cwd: folder,
      encoding: 'utf8',
      env: { ...process.env, PATH: `${dirname(program)}:${process.env.PATH}` },
    }),
  ) as {
    samples: number
    yield: number
    worst: { critical_stiffness: number; parameters: Record<string, number> }
    tighten_first: string | null
  }
  expect(study.samples).toBe(300)
  const shown = await page.locator('#body-study').innerText()
  expect(shown).toContain(`${Number((100 * study.yield).toPrecision(4))} % of the units reach`)
  expect(shown).toContain(say(study.worst.critical_stiffness, 'N/m'))
  await page.evaluate(axe.source)
  const found = await page.evaluate(async () =>
    (await (window as unknown as { axe: typeof axe }).axe.run(document, { resultTypes: ['violations'] })).violations.map(
      (each) => `${each.id}: ${each.nodes[0]?.html}`,
    ),
  )
  expect(found).toEqual([])
  await expect
    .poll(() => page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth))
    .toBeLessThanOrEqual(0)
  // A link has it too.
  const again = await openPage(here, width, await addressOf(page))
  await show(again.page, 'Study')
  await again.page.locator('[data-answer="yield"]').waitFor()
  await again.context.close()
  await page.getByRole('button', { name: 'Look at it: the worst, nobody holding' }).click()
  if (width < 900) await show(page, 'Device')
  await expect
    .poll(() => row(page, 'body.handle.damping').locator('input[type="text"]').inputValue())
    .toBe(say(study.worst.parameters['body.handle.damping']!, 'N s/m'))
  expect(complaints).toEqual([])
  await context.close()
})
