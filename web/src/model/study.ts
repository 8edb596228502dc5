// What varies from unit to unit, as the panel of a study keeps it and as the program reads it (docs/study.md).

import { shifted, tomlOfTyped } from './decimal'

/** How one number varies; texts as typed, so that the program judges them. */
export interface Spread {
  key: string
  kind: string
  a: string
  b: string
}
interface Kind {
  label: string
  distribution: string
  a?: [key: string, label: string] // what is typed
  b?: [key: string, label: string]
}
export const kinds: Record<string, Kind> = {
  'normal-share': {
    label: 'normal, by a share of it',
    distribution: 'normal',
    a: ['relative_deviation', 'deviation, such as 5 %'],
  },
  'uniform-share': { label: 'even, by a share of it', distribution: 'uniform', a: ['relative_tolerance', 'at most, such as 5 %'] },
  normal: { label: 'normal', distribution: 'normal', a: ['standard_deviation', 'standard deviation'] },
  uniform: { label: 'even between', distribution: 'uniform', a: ['lower', 'from'], b: ['upper', 'to'] },
  triangular: { label: 'likeliest as it is', distribution: 'triangular', a: ['lower', 'from'], b: ['upper', 'to'] },
  lognormal: { label: 'lognormal', distribution: 'lognormal', a: ['log_deviation', 'of its logarithm, such as 0.1'] },
  device: { label: 'as its file’s uncertainty', distribution: 'device' },
}

export interface StudyAsked {
  spreads: Spread[]
  stiffness?: string | undefined // that every unit must reach
  anyUser?: string | undefined
}

const isSpread = (value: unknown): value is Spread =>
  typeof value === 'object' &&
  value !== null &&
  ['key', 'kind', 'a', 'b'].every((each) => typeof (value as Record<string, unknown>)[each] === 'string')
/** As a link holds them; what cannot be read is none. */
export function spreadsOf(text: string | undefined): Spread[] {
  try {
    const found: unknown = JSON.parse(text ?? '[]')
    return Array.isArray(found) ? found.filter(isSpread).filter(({ kind }) => kind in kinds) : []
  } catch {
    return []
  }
}

/** "5 %" is 0.05. */
const share = (text: string): string => {
  const [, number] = /^([\d.]+)\s*%$/.exec(text.trim()) ?? []
  return number === undefined || Number.isNaN(Number(number)) ? text : shifted(number, -2)
}
/** The study's file; null while nothing varies, or something that varies has no number yet. */
export function studyText({ spreads, stiffness, anyUser }: StudyAsked): string | null {
  if (spreads.length === 0) return null
  const parts: string[] = []
  if (stiffness || anyUser) {
    parts.push('[specification]')
    if (stiffness) parts.push(`critical_stiffness = ${tomlOfTyped(stiffness)}`)
    if (anyUser) parts.push(`any_user = ${tomlOfTyped(anyUser)}`)
  }
  for (const spread of spreads) {
    const kind = kinds[spread.kind]!
    parts.push('[[parameter]]', `key = ${JSON.stringify(spread.key)}`, `distribution = "${kind.distribution}"`)
    for (const [typed, named] of [
      [spread.a, kind.a],
      [spread.b, kind.b],
    ] as const) {
      if (named && typed.trim() === '') return null
      if (named) parts.push(`${named[0]} = ${tomlOfTyped(share(typed))}`)
    }
  }
  return parts.join('\n') + '\n'
}
