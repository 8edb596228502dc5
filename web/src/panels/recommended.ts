// A wall that the program recommends, as the file's numbers.
import { messageIn, post } from '../api/client'
import type { Recommendation, WallToRender } from '../api/documents'
import { tomlOfNumber } from '../model/decimal'
import { countOf } from '../model/keys'
import type { Settings } from '../model/snapshot'
import { workbench } from '../model/workbench.svelte'
import { notice, showPanel } from './open.svelte'

/** What its panel is asked. */
export const askedOf = ({ gainMarginDb, phaseMarginDeg, ripple, goal }: Settings): Record<string, string> => ({
  ...(gainMarginDb ? { 'gain-margin-db': gainMarginDb } : {}),
  ...(phaseMarginDeg ? { 'phase-margin-deg': phaseMarginDeg } : {}),
  ...(ripple ? { ripple } : {}),
  ...(goal ? { goal } : {}),
})

export const numbersOf = (wall: WallToRender): Record<string, number> => ({
  'wall.stiffness': wall.stiffness,
  'wall.damping': wall.damping,
  'wall.velocity_filter_hz': wall.velocity_filter_hz,
})

/** The filters that the file does not have yet, as the document states them. */
export const added = ({ filters, has_new_notch }: WallToRender): WallToRender['filters'] =>
  has_new_notch ? filters.slice(countOf(workbench.scanned, 'wall', 'filter')) : []
export const newFilters = (wall: WallToRender): string =>
  added(wall)
    .map((each) =>
      [
        '[[wall.filter]]',
        `type = ${JSON.stringify(each.type)}`,
        ...(['frequency_hz', 'damping_ratio', 'depth'] as const).map((key) => `${key} = ${tomlOfNumber(Number(each[key]))}`),
        '',
      ].join('\n'),
    )
    .join('\n')

/** Puts the one recommended into the file; where there is none its panel says why. */
export async function takeRecommended(): Promise<void> {
  const toml = workbench.toml
  try {
    const found = await post<Recommendation>('recommend', JSON.stringify({ device_toml: toml, options: askedOf(workbench.settings) }))
    if (toml !== workbench.toml) return // it was of another device
    const { wall } = found
    if (!wall) return showPanel('recommend')
    const values = Object.fromEntries(Object.entries(numbersOf(wall)).map(([key, value]) => [key, tomlOfNumber(value)]))
    workbench.edit(values, null, newFilters(wall))
  } catch (error) {
    notice.text = messageIn(error)
  }
}
