// What the page copies as Python, run: the numbers of the program.
import { execFileSync } from 'node:child_process'
import { expect, it } from 'vitest'
import { documentOf, openPage, place, runPalette, settled, type } from './program'

const packages = process.env.ZWIDTH_PYTHON // the folder of the module; without one tests/run leaves this file out
const here = place('devices/lhifam.toml')

it('copies Python that imports zwidth and gives the same numbers', async () => {
  const { page, complaints } = await openPage(here, 1280)
  await type(page, 'loop.delay', '0.3 ms')
  await type(page, 'body.handle.damping', '4.2')
  await settled(page)
  await runPalette(page, 'copy as python')
  const code = await page.evaluate(() => navigator.clipboard.readText())
  const printed = execFileSync('/usr/bin/python3', ['-c', code], { encoding: 'utf8', env: { ...process.env, PYTHONPATH: packages } })
  const answer = documentOf('analyze', 'devices/lhifam.toml', '--set', 'loop.delay=0.3 ms', '--set', 'body.handle.damping=4.2')
  const [stiffness, unit, verdict] = printed.trim().split(' ')
  expect(Number(stiffness)).toBe(answer.critical_stiffness)
  expect([unit, verdict]).toEqual(['N/m', 'sound'])
  expect(complaints).toEqual([])
})
