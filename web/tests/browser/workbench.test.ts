import { execFileSync } from 'node:child_process'
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs'
import { tmpdir } from 'node:os'
import { dirname } from 'node:path'
import { describe, expect, it } from 'vitest'
import { askAll, nobody, openPage, place, program, project, runPalette, serve, settled, show, type, withWall } from './program'

const here = place('devices/lhifam.toml')

describe('work habits', () => {
  it('copies a command that gives the same numbers in any folder', async () => {
    const { page, context } = await openPage(here, 1280)
    await type(page, 'loop.delay', '0.3 ms')
    await type(page, 'body.handle.damping', '4.2')
    await settled(page)
    const path = `${dirname(program)}:${process.env.PATH}`
    const numberOf = (command: string): number =>
      (
        JSON.parse(
          execFileSync('bash', ['-c', command.replace(/(zwidth analyze .*)/, '$1 --json')], {
            cwd: tmpdir(),
            encoding: 'utf8',
            env: { ...process.env, PATH: path },
          }),
        ) as { critical_stiffness: number }
      ).critical_stiffness
    await runPalette(page, 'copy as command: analyze')
    const short = await page.evaluate(() => navigator.clipboard.readText())
    expect(short).toMatch(/^zwidth analyze - <<'END_OF_DEVICE'\n/)
    expect(`${(numberOf(short) / 1000).toPrecision(4)} kN/m`).toBe(await nobody(page))
    // A device of one's own goes with the command.
    await runPalette(page, 'show: device file')
    await page
      .locator('#toml')
      .fill((await page.locator('#toml').inputValue()).replace('name = "LHIfAM, translational axis"', 'name = "It\'s mine"'))
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
    for (const [tab, name, start] of [
      ['Frequency', 'Save Bode magnitude as SVG', '<svg'],
      ['Frequency', 'Save Which stiffness is stable as PNG', '\x89PNG'],
      ['Wall', 'Save the numbers of Stiff and damped walls as CSV', 'curve,'],
    ] as const) {
      await show(page, tab)
      await settled(page)
      if (name.includes('Which stiffness')) await page.getByRole('button', { name: 'Save Which stiffness is stable', exact: true }).click()
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
  await askAll(page)
  await page.setViewportSize({ width: 1280, height: 3000 }) // what is out of view waits
  for (const [tab, panel] of [
    ['Change', 'limits'],
    ['Wall', 'region'],
    ['Time', 'time'],
    ['Frequency', 'bode'],
    ['Wall', 'recommend'],
  ] as const) {
    await show(page, tab)
    await settled(page)
    await expect.poll(() => page.locator(`#panel-${panel}`).innerText()).toMatch(/doubtful: .*measured by a guess/)
  }
  expect(complaints).toEqual([])
  await context.close()
  await other.stop()
  rmSync(folder, { recursive: true })
})
