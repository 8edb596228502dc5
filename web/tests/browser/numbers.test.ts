// Every panel's numbers are those that the program prints with --json.
import { expect, it } from 'vitest'
import { percent, rounded, say } from '../../src/model/decimal'
import { documentOf, askAll, openPage, onEachTab, place, show, type } from './program'

const here = place('devices/lhifam.toml')

const wall = ['devices/lhifam.toml', '--set', 'wall.stiffness=3000', '--set', 'wall.damping=4']
const [K, B] = ['N/m', 'N s/m']

it('shows the numbers of every document', async () => {
  const { page, context, complaints } = await openPage(here, 1280)
  await type(page, 'wall.stiffness', '3000 N/m')
  await type(page, 'wall.damping', '4 N s/m')
  await askAll(page)
  await page.setViewportSize({ width: 1280, height: 4000 }) // what is out of view waits
  await onEachTab(page, async () => {})
  const panel = (id: string): Promise<string> => page.locator(`#body-${id}`).innerText()
  const holds = async (id: string, texts: string[]): Promise<void> => {
    const shown = await panel(id)
    for (const text of texts) expect(shown, id).toContain(text)
    expect(texts.length).toBeGreaterThan(1)
  }

  const design = documentOf('design', ...wall) as unknown as {
    sensitivities: { value: number; unit: string; relative: number | null; any_user_relative: number | null }[]
  }
  const felt = design.sensitivities.filter((each) => each.relative !== null && Math.abs(each.relative) > 5e-4)
  await holds(
    'limits',
    felt.flatMap((each) => [say(each.value, each.unit), percent(each.relative! / 10)]),
  )
  const target = documentOf('design', ...wall, '--target', '12 kN/m') as unknown as {
    targets: { value_needed: number | null; why: string }[]
  }
  await show(page, 'Change')
  await page.getByText('Numbers that alone cannot').click()
  await holds(
    'limits',
    target.targets.map((each) => each.why),
  )

  const region = documentOf('region', ...wall) as unknown as {
    stiffest: { stiffness: number; damping: number }
    any_user: { stiffest: { stiffness: number; damping: number } }
  }
  await holds('region', [
    say(region.any_user.stiffest.stiffness, K),
    say(region.any_user.stiffest.damping, B),
    say(region.stiffest.stiffness, K, 3),
  ])

  // The two limits of the answer are beside the wall's own damper; the bar has them both.
  const analysis = documentOf('analyze', ...wall) as unknown as {
    limits: Record<'nobody' | 'any_user', { critical_stiffness: number }>
  }
  expect(await page.locator('[data-answer="at-damping"]').innerText()).toContain(say(4, B))
  expect(await page.locator('[data-answer="of-both"]').count()).toBe(1)
  for (const [bar, holder] of [
    ['nobody', 'nobody'],
    ['any-user', 'any_user'],
  ] as const)
    expect(await page.locator(`[data-bar="${bar}"]`).textContent()).toBe(say(analysis.limits[holder].critical_stiffness, K))

  interface Option {
    wall: { stiffness: number; damping: number } | null
    margins: { gain_margin_db: number | null } | null
    force_per_count: { largest: number | null } | null
  }
  const recommended = documentOf('design', ...wall, '--recommend') as unknown as Option & { alternatives: Option[] }
  await holds(
    'recommend',
    [recommended, ...recommended.alternatives]
      .filter((each) => each.wall)
      .flatMap((each) => [
        say(each.wall!.stiffness, K),
        say(each.wall!.damping, B),
        `${say(each.margins!.gain_margin_db, '', 3)} dB`,
        say(each.force_per_count!.largest, 'N', 3),
      ]),
  )

  const diagnosis = documentOf('diagnose', ...wall, '--oscillates-hz', '41') as unknown as {
    candidates: { why: string }[]
    changes: { limit_then: number | null }[]
  }
  await holds('diagnose', [...diagnosis.candidates.map((each) => each.why), ...diagnosis.changes.map((each) => say(each.limit_then, K))])

  const relay = documentOf('relay', ...wall, '--amplitude', '5') as unknown as {
    mean: { stiffness: number; frequency_hz: number }
    predictions: { crossovers: { stiffness: number; frequency_hz: number }[] }
    explanation: string[]
  }
  await holds('relay', [
    ...[relay.mean, ...relay.predictions.crossovers].flatMap((each) => [say(each.stiffness, K), say(each.frequency_hz, 'Hz')]),
    ...relay.explanation,
  ])

  const hit = documentOf('analyze', ...wall) as unknown as { wall: { stiffness: number }; rigid_approximation: { mass: number } }
  const speed = rounded(1e-3 * Math.sqrt(hit.wall.stiffness / hit.rigid_approximation.mass))
  const simulation = documentOf('simulate', ...wall, '--wall-position', '0.0001', '--start-velocity', String(speed)) as unknown as {
    peak_penetration: number
    oscillation: { frequency_hz: number; amplitude: number } | null
  }
  const { oscillation } = simulation
  await holds('time', [
    say(simulation.peak_penetration, 'm'),
    ...(oscillation ? [say(oscillation.frequency_hz, 'Hz'), say(oscillation.amplitude, 'm')] : ['It settles.']),
  ])

  const bode = documentOf('bode', ...wall) as unknown as { crossovers: { stiffness: number }[] }
  await holds('bode', [...bode.crossovers.map((each) => say(each.stiffness, K, 3)), 'Nyquist'])

  // The table of a curve has the very numbers of the document.
  const sampled = (bode as unknown as { sampled: { frequency_rad_s: number[]; magnitude_db: number[] } }).sampled
  await show(page, 'Frequency')
  await page.getByRole('button', { name: 'Table of Bode magnitude' }).click()
  const cells = await page.locator('#body-bode .table-scroll tbody tr').first().locator('td').allInnerTexts()
  expect(cells).toEqual(['sampled', say(sampled.frequency_rad_s[0]! / (2 * Math.PI), '', 5), say(sampled.magnitude_db[0], '', 5)])
  expect(complaints).toEqual([])
  await context.close()
})
