import { execFileSync } from 'node:child_process'
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs'
import { tmpdir } from 'node:os'
import { dirname } from 'node:path'
import axe from 'axe-core'
import { describe, expect, it } from 'vitest'
import { alone, documentOf, openAll, openPage, place, program, project, row, runPalette, serve, settled, type, withWall } from './program'

const here = place('devices/lhifam.toml')

describe.each([
  ['desktop', 1280],
  ['phone', 390],
])('%s', (_, width) => {
  it('shows the program’s own answer, prints how soon, and asks nobody else', async () => {
    const started = Date.now()
    const { page, context, complaints } = await openPage(here, width)
    const took = Date.now() - started
    const sincePage = await page.evaluate(() => performance.now())
    console.log(`first answer at most ${sincePage.toFixed(0)} ms after the start of the page, ${took} ms with opening the tab`)
    const answer = documentOf('analyze', 'devices/lhifam.toml')
    expect(await alone(page)).toBe(`${(Number(answer.critical_stiffness) / 1000).toPrecision(4)} kN/m`)
    expect(await page.locator('[data-answer="limited-by"]').innerText()).toContain('the rigid body')
    expect(await page.locator('[data-answer="trust"]').innerText()).toContain('sound')
    expect(await page.evaluate(() => performance.getEntriesByType('resource').length)).toBeLessThan(20)
    expect(took).toBeLessThan(3000)
    await settled(page)
    expect(await page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth)).toBeLessThanOrEqual(0)
    expect(complaints).toEqual([])
    await context.close()
  })

  it('takes numbers with units, by key and by drag, and takes them back', async () => {
    const { page, context, complaints } = await openPage(here, width)
    await type(page, 'loop.delay', '0.25 ms')
    await settled(page)
    const delayed = documentOf('analyze', 'devices/lhifam.toml', '--set', 'loop.delay=0.25 ms')
    expect(await alone(page)).toBe(`${(Number(delayed.critical_stiffness) / 1000).toPrecision(4)} kN/m`)
    const text = row(page, 'loop.delay').locator('input[type="text"]')
    expect(await text.inputValue()).toBe('0.25 ms')
    await text.press('ArrowUp')
    expect(await text.inputValue()).toBe('0.2525 ms')
    await text.press('Shift+ArrowUp')
    expect(await text.inputValue()).toBe('0.2778 ms')
    await text.press('PageUp')
    expect(await text.inputValue()).toBe('0.5556 ms')
    const slider = row(page, 'loop.delay').locator('input[type="range"]')
    await slider.focus()
    await slider.press('Home')
    expect(await text.inputValue()).toBe('0 ms')
    for (let i = 0; i < 5; ++i) await page.keyboard.press('Control+z')
    expect(await text.inputValue()).toBe('0 s')
    await settled(page)
    expect(await alone(page)).toBe('8.849 kN/m')

    // A drag of the slider is one step.
    const box = (await row(page, 'link.0.stiffness').locator('input[type="range"]').boundingBox())!
    await row(page, 'link.0.stiffness').scrollIntoViewIfNeeded()
    const now = (await row(page, 'link.0.stiffness').locator('input[type="range"]').boundingBox()) ?? box
    await page.mouse.move(now.x + now.width / 2, now.y + now.height / 2)
    await page.mouse.down()
    for (let i = 1; i <= 10; ++i) await page.mouse.move(now.x + now.width / 2 + 2 * i, now.y + now.height / 2)
    await page.mouse.up()
    expect(await row(page, 'link.0.stiffness').locator('input[type="text"]').inputValue()).not.toBe('79.5 kN/m')
    await page.keyboard.press('Control+z')
    expect(await row(page, 'link.0.stiffness').locator('input[type="text"]').inputValue()).toBe('79.5 kN/m')
    await page.keyboard.press('Control+Shift+z')
    expect(await row(page, 'link.0.stiffness').locator('input[type="text"]').inputValue()).not.toBe('79.5 kN/m')
    expect(complaints).toEqual([])
    await context.close()
  })

  it('takes a bare number as SI; nothing of the text before it sticks', async () => {
    const { page, context, complaints } = await openPage(here, width)
    const field = (key: string) => row(page, key).locator('input[type="text"]')
    await type(page, 'link.0.stiffness', '79500')
    expect(await field('link.0.stiffness').inputValue()).toBe('79.5 kN/m')
    await type(page, 'link.0.stiffness', '65 N/mm')
    expect(await field('link.0.stiffness').inputValue()).toBe('65 N/mm')
    await type(page, 'link.0.stiffness', '79500')
    expect(await field('link.0.stiffness').inputValue()).toBe('79.5 kN/m')
    expect(await field('link.0.stiffness').getAttribute('title')).toContain('79500 or 79.5 kN/m')
    await settled(page)
    expect(await alone(page)).toBe('8.849 kN/m')
    await type(page, 'sensor.resolution', '4096 counts')
    await row(page, 'sensor.resolution').locator('.problem').waitFor()
    await type(page, 'sensor.resolution', '4096')
    expect(await field('sensor.resolution').inputValue()).toBe('4.096 km')
    expect(complaints).toEqual([])
    await context.close()
  })

  it('shows the unit of every number, and all digits where it is edited', async () => {
    const { page, context, complaints } = await openPage(here, width)
    const field = row(page, 'body.handle.damping').locator('input[type="text"]')
    await type(page, 'body.handle.damping', '0.0127828981167')
    expect(await field.inputValue()).toBe('12.7828981167 mN s/m')
    await page.locator('h1').click()
    expect(await field.inputValue()).toBe('12.78 mN s/m')
    expect(await field.getAttribute('title')).toContain('12.7828981167 mN s/m')
    await settled(page)
    const answer = await alone(page)
    await field.click()
    expect(await field.inputValue()).toBe('12.7828981167 mN s/m')
    await page.keyboard.press('Enter')
    await page.locator('h1').click()
    await settled(page)
    expect(await alone(page)).toBe(answer)
    expect(await page.getByRole('button', { name: 'Undo' }).isEnabled()).toBe(true)
    await page.getByRole('button', { name: 'Undo' }).click()
    expect(await page.getByRole('button', { name: 'Undo' }).isEnabled()).toBe(false)
    expect(complaints).toEqual([])
    await context.close()
  })

  it('drags the wall on the bar and in the region, one step each', async () => {
    const { page, context, complaints } = await openPage(here, width)
    await withWall(page)
    await settled(page)
    const stiffness = row(page, 'wall.stiffness').locator('input[type="text"]')
    const before = await stiffness.inputValue()
    for (const [panel, dx, dy] of [
      ['bar', -40, 0],
      ['region', 40, -60],
    ] as const) {
      const handle = page.locator(`#panel-${panel} .handle`)
      await handle.scrollIntoViewIfNeeded()
      await page.evaluate((id) => document.getElementById(`panel-${id}`)!.scrollIntoView({ block: 'center' }), panel)
      const box = (await handle.locator('.reach').boundingBox())!
      const [x, y] = [box.x + box.width / 2, box.y + box.height / 2]
      await page.mouse.move(x, y)
      await page.mouse.down()
      for (let i = 1; i <= 8; ++i) await page.mouse.move(x + (dx * i) / 8, y + (dy * i) / 8)
      await page.mouse.up()
      expect(await stiffness.inputValue(), panel).not.toBe(before)
      await page.getByRole('button', { name: 'Undo' }).click()
      expect(await stiffness.inputValue(), panel).toBe(before)
    }
    // The same by keys.
    await page.locator('#panel-region .handle').focus()
    await page.keyboard.press('ArrowRight')
    await page.keyboard.press('Shift+ArrowDown')
    expect(await row(page, 'wall.damping').locator('input[type="text"]').inputValue()).not.toBe('0 N s/m')
    expect(await stiffness.inputValue()).not.toBe(before)
    await settled(page)
    expect(await page.locator('[data-answer="wall"]').innerText()).toContain('stable')
    expect(complaints).toEqual([])
    await context.close()
  })

  it('says an error at its field, and gives no number', async () => {
    const { page, context } = await openPage(here, width)
    await type(page, 'body.motor.mass', '-1')
    await row(page, 'body.motor.mass').locator('.problem').waitFor()
    expect(await row(page, 'body.motor.mass').locator('input[type="text"]').getAttribute('aria-invalid')).toBe('true')
    expect(await page.locator('[data-answer="alone"]').count()).toBe(0)
    await type(page, 'body.motor.mass', '3 N')
    await page.waitForFunction(() => /no unit of a mass/.test(document.querySelector('[data-key="body.motor.mass"] .problem')?.textContent ?? ''))
    await page.keyboard.press('Control+z')
    await page.keyboard.press('Control+z')
    await page.waitForSelector('[data-answer="alone"]')
    expect(await alone(page)).toBe('8.849 kN/m')
    await context.close()
  })

  it('shares all of it in the address', async () => {
    const { page, context } = await openPage(here, width)
    await type(page, 'link.0.stiffness', '65.4321 kN/m')
    await row(page, 'body.handle.mass').getByRole('button', { name: /Lock/ }).click()
    await page.getByRole('button', { name: 'Pin', exact: true }).click()
    await type(page, 'loop.delay', '1.5e-4')
    await settled(page)
    await page.waitForTimeout(400)
    const [answer, file, hash] = [await alone(page), await page.locator('#toml').count(), new URL(page.url()).hash]
    expect(file).toBe(0)
    expect(hash.length).toBeLessThanOrEqual(2048 + 3)
    const again = await openPage(here, width, hash)
    expect(await alone(again.page)).toBe(answer)
    expect(await row(again.page, 'body.handle.mass').locator('input[type="text"]').isDisabled()).toBe(true)
    await settled(again.page)
    expect(await again.page.locator('#panel-bar').innerText()).toContain('design 1')
    await again.context.close()
    await context.close()
  })

  it('is usable by all: no violation, light and dark, with every panel open', async () => {
    for (const scheme of ['light', 'dark'] as const) {
      const { page, context, complaints } = await openPage(here, width, '', scheme)
      await withWall(page)
      await openAll(page)
      await page.getByRole('button', { name: 'Pin', exact: true }).click()
      await page.getByRole('button', { name: 'Table of Bode magnitude' }).click()
      await page.getByLabel(/choose it/).setInputFiles(`${project}/recordings/locked_chirp.csv`)
      await page.getByRole('button', { name: 'Fit', exact: true }).click()
      await page.getByRole('button', { name: 'Use this device' }).waitFor()
      await settled(page)
      await page.evaluate(axe.source)
      const found = await page.evaluate(async () => {
        const results = await (window as unknown as { axe: typeof axe }).axe.run(document, { resultTypes: ['violations'] })
        return results.violations.map((each) => `${each.id}: ${each.nodes.slice(0, 3).map((node) => `${node.html.slice(0, 160)} ${node.failureSummary ?? ''}`).join(' | ')} (${each.nodes.length})`)
      })
      expect(found, scheme).toEqual([])
      expect(await page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth)).toBeLessThanOrEqual(0)
      expect(complaints).toEqual([])
      await context.close()
    }
  })

  it('goes from a recording to a device', async () => {
    const { page, context, complaints } = await openPage(here, width)
    await runPalette(page, 'show: from a recording')
    await page.getByLabel(/choose it/).setInputFiles(`${project}/recordings/locked_chirp.csv`)
    await page.getByLabel('Fit').selectOption('device')
    await page.getByLabel('handle', { exact: true }).check()
    await page.getByRole('button', { name: 'Fit', exact: true }).click()
    await page.getByRole('button', { name: 'Use this device' }).waitFor()
    await settled(page)
    await page.getByRole('button', { name: 'Use this device' }).click()
    await page.waitForFunction(() => /interval|between/i.test(document.querySelector('.answer')?.textContent ?? ''))
    const fitted = documentOf('identify', 'recordings/locked_chirp.csv', '--force', 'force', '--position', 'position', '--structure', 'devices/lhifam.toml', '--locked', 'handle')
    await settled(page)
    expect(await alone(page)).toBe(`${(Number(fitted.critical_stiffness) / 1000).toPrecision(4)} kN/m`)
    expect(complaints).toEqual([])
    await context.close()
  })
})

describe('work habits', () => {
  it('copies a command that gives the same numbers', async () => {
    const { page, context } = await openPage(here, 1280)
    await type(page, 'loop.delay', '0.3 ms')
    await type(page, 'body.handle.damping', '4.2')
    await settled(page)
    const path = `${dirname(program)}:${process.env.PATH}`
    const numberOf = (command: string): number =>
      (JSON.parse(execFileSync('bash', ['-c', command.replace(/(zwidth analyze .*)/, '$1 --json')], { cwd: project, encoding: 'utf8', env: { ...process.env, PATH: path } })) as { critical_stiffness: number }).critical_stiffness
    await runPalette(page, 'copy as command: analyze')
    const short = await page.evaluate(() => navigator.clipboard.readText())
    expect(short).toBe('zwidth analyze devices/lhifam.toml --set body.handle.damping=4.2 --set \'loop.delay=0.3 ms\'')
    expect(`${(numberOf(short) / 1000).toPrecision(4)} kN/m`).toBe(await alone(page))
    // A device of one's own goes with the command.
    await runPalette(page, 'show: device file')
    await page.locator('#toml').fill((await page.locator('#toml').inputValue()).replace('name = "LHIfAM, translational axis"', 'name = "It\'s mine"'))
    await page.locator('#toml').blur()
    await runPalette(page, 'copy as command: analyze')
    const long = await page.evaluate(() => navigator.clipboard.readText())
    expect(long).toContain("<<'END_OF_DEVICE'")
    expect(numberOf(long)).toBe(numberOf(short))
    await context.close()
  })

  it('saves every figure as SVG, PNG and CSV', async () => {
    const { page, context, complaints } = await openPage(here, 1280)
    await withWall(page)
    await settled(page)
    for (const [name, start] of [
      ['Save Bode magnitude as SVG', '<svg'],
      ['Save Which stiffness is stable as PNG', '\x89PNG'],
      ['Save the numbers of Stiff and damped walls as CSV', 'curve,'],
    ] as const) {
      const [download] = await Promise.all([page.waitForEvent('download'), page.getByRole('button', { name }).click()])
      const bytes = readFileSync(await download.path())
      expect(bytes.subarray(0, start.length).toString('latin1')).toBe(start)
      expect(bytes.length).toBeGreaterThan(1000)
    }
    expect(complaints).toEqual([])
    await context.close()
  })
})

it('says in every panel of numbers that a doubtful device is one', async () => {
  const folder = mkdtempSync(`${tmpdir()}/zwidth-`)
  const file = `${folder}/doubtful.toml`
  const text = readFileSync(`${project}/devices/lhifam.toml`, 'utf8')
  writeFileSync(file, `${text}\n[uncertainty]\nverdict = "doubtful"\nwarning = "measured by a guess"\n`)
  const other = await serve(file)
  const { page, context, complaints } = await openPage({ browser: here.browser, served: other }, 1280)
  expect(await page.locator('[data-answer="trust"]').innerText()).toContain('doubtful')
  await withWall(page)
  await openAll(page)
  await page.setViewportSize({ width: 1280, height: 6000 }) // what is out of view waits
  await settled(page)
  for (const panel of ['limits', 'region', 'time', 'bode', 'recommend']) {
    await expect.poll(() => page.locator(`#panel-${panel}`).innerText(), { timeout: 10_000 }).toMatch(/doubtful: .*measured by a guess/)
  }
  expect(complaints).toEqual([])
  await context.close()
  await other.stop()
  rmSync(folder, { recursive: true })
})
