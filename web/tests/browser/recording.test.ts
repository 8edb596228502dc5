// From a recording to a device: it is read, cut, fitted, and fitted again by the command that is copied.
import { execFileSync } from 'node:child_process'
import { copyFileSync, mkdtempSync, rmSync, writeFileSync } from 'node:fs'
import { tmpdir } from 'node:os'
import { dirname } from 'node:path'
import { afterAll, expect, it } from 'vitest'
import { say } from '../../src/model/decimal'
import { openPage, place, program, project, runPalette, settled } from './program'

const folder = mkdtempSync(`${tmpdir()}/zwidth-`)
const here = place('devices/lhifam.toml')
afterAll(() => rmSync(folder, { recursive: true }))

const run = (command: string): Record<string, unknown> =>
  JSON.parse(
    execFileSync('bash', ['-c', command], {
      cwd: folder,
      encoding: 'utf8',
      env: { ...process.env, PATH: `${dirname(program)}:${process.env.PATH}` },
    }),
  ) as Record<string, unknown>

/** A knob on a spring to the ground, pushed by a multisine of torque; angles in counts of 0.1 mrad. */
function knob(): string {
  const [inertia, damping, stiffness, period] = [2e-4, 1.5e-3, 0.02, 1e-3]
  const waves = Array.from({ length: 99 }, (_, i) => ({ w: Math.PI * (i + 1), phase: (i * i * Math.PI) / 99 }))
  const rows: string[] = []
  let [angle, speed] = [0, 0]
  for (let i = 0; i < 8000; ++i) {
    const torque = 1.4e-3 * waves.reduce((sum, { w, phase }) => sum + Math.sin(w * i * period + phase), 0)
    rows.push(`${(i * period).toFixed(3)},${(1e3 * torque).toPrecision(7)},${Math.round(angle / 1e-4)}`)
    for (let k = 0; k < 10; ++k) {
      speed += ((torque - damping * speed - stiffness * angle) / inertia) * (period / 10)
      angle += speed * (period / 10)
    }
  }
  return `time,torque [mNm],angle [counts]\n${rows.join('\n')}\n`
}

it('asks for what its columns do not say, and shows the spring that the record does', async () => {
  writeFileSync(`${folder}/knob.csv`, knob())
  const { page, context, complaints } = await openPage(here, 1280)
  await runPalette(page, 'show: from a recording')
  await page.getByLabel(/choose it/).setInputFiles(`${folder}/knob.csv`)
  await page.locator('#column-force').waitFor()
  await page.getByText('Its name says counts').waitFor()
  await page.getByRole('button', { name: 'Take 1 mN m, as its name says' }).click()
  await page.getByLabel('One unit of the position is').fill('1e-4 rad')
  await page.keyboard.press('Tab')
  await expect.poll(() => page.getByText('Its name says counts').count()).toBe(0)
  expect(await page.getByLabel('One unit of the force is').inputValue()).toBe('1 mN m')
  await page.getByLabel('Fit', { exact: true }).selectOption('rigid')
  await page.getByRole('button', { name: 'Fit', exact: true }).click()
  await page.getByRole('button', { name: 'Use this device' }).waitFor()
  await settled(page)
  await page.getByRole('button', { name: 'Copy as command: From a recording to a device' }).click()
  const fitted = run(`${await page.evaluate(() => navigator.clipboard.readText())} --json`) as {
    critical_stiffness: number
    rivals: { code: string; value: number }[]
  }
  const spring = fitted.rivals.find((each) => each.code === 'ground_spring')!.value
  expect(spring).toBeCloseTo(0.02, 3)
  await expect.poll(() => page.locator('[data-answer="ground-spring"]').innerText()).toContain(say(spring, 'N m/rad'))
  await expect.poll(() => page.locator('#body-recording').innerText()).toContain(say(fitted.critical_stiffness, 'N m/rad'))
  await page.getByRole('button', { name: 'Use this device' }).click()
  await expect.poll(() => page.locator('[data-key="body.body.stiffness"] input[type="text"]').inputValue()).toBe(say(spring, 'N m/rad'))
  expect(complaints).toEqual([])
  await context.close()
})

it('uses the part that is dragged over, and copies its fit as a command', async () => {
  copyFileSync(`${project}/recordings/free_motion.csv`, `${folder}/free_motion.csv`)
  const { page, context, complaints } = await openPage(here, 1280)
  await runPalette(page, 'show: from a recording')
  await page.getByLabel(/choose it/).setInputFiles(`${folder}/free_motion.csv`)
  await page.getByText('free_motion.csv: text, 3 columns of 5000 samples').waitFor()
  const figure = page.locator('svg[aria-label="Position as recorded"]')
  await figure.scrollIntoViewIfNeeded()
  const box = (await figure.boundingBox())!
  await page.mouse.move(box.x + 0.4 * box.width, box.y + 40)
  await page.mouse.down()
  await page.mouse.move(box.x + 0.97 * box.width, box.y + 60, { steps: 4 })
  await page.mouse.up()
  await page.getByRole('button', { name: 'Use all of it' }).waitFor()
  const samples = async (): Promise<number> =>
    Number(/columns of (\d+) samples/.exec(await page.locator('#body-recording').innerText())?.[1])
  await expect.poll(samples).toBeLessThan(4000)
  const kept = await samples()
  expect(kept).toBeGreaterThan(2000)
  await page.getByLabel('Fit', { exact: true }).selectOption('rigid')
  await page.getByRole('button', { name: 'Fit', exact: true }).click()
  await page.getByRole('button', { name: 'Use this device' }).waitFor()
  await settled(page)
  await page.getByRole('button', { name: 'Copy as command: From a recording to a device' }).click()
  const fitted = run(`${await page.evaluate(() => navigator.clipboard.readText())} --json`)
  await expect.poll(() => page.locator('#body-recording').innerText()).toContain(say(Number(fitted.critical_stiffness), 'N/m'))
  // By numbers too; emptied, all of it is used.
  await page.getByLabel('Used from (time)').fill('')
  await page.getByLabel('Used from (time)').press('Enter')
  await expect.poll(samples).toBeGreaterThan(kept + 1000)
  await page.getByRole('button', { name: 'Use all of it' }).click()
  await expect.poll(samples).toBe(5000)
  expect(complaints).toEqual([])
  await context.close()
})
