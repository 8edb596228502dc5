// The documents' enums as words, and what the terms mean.

import type { Analysis, Finding, ForAnyUser, HolderLimit, LimitedBy, Remark, Trust } from '../api/documents'
import { say } from './decimal'

export const limiter = (limited: LimitedBy | null | undefined): string =>
  !limited ? 'not known' : limited.kind === 'rigid_body' ? 'the rigid body' : `vibration mode ${limited.mode}`

export const trustWord: Record<Trust['verdict'], string> = { sound: 'sound', doubtful: 'doubtful', refused: 'refused' }
export const trustSign: Record<Trust['verdict'], string> = { sound: '✓', doubtful: '!', refused: '✕' }

/** Those that a document's findings list, each once and in their order: what matters most comes first. */
export function asListed<T>(said: T[], findings: Finding[], text: (each: T) => string): T[] {
  const of = new Map(said.map((each) => [text(each), each]))
  return findings.flatMap((each) => of.get(each.text) ?? [])
}

/** A remark as a finding's text has it. */
export const remarkLine = ({ what, consequence, remedy }: Remark): string =>
  [what, consequence, remedy].filter((part) => part !== '').join('; ')

/** In place of a limit that is no number. */
export const limitWord = ({ status, stable_intervals }: Pick<Analysis, 'status' | 'stable_intervals'>): string =>
  status === 'unbounded'
    ? 'every wall is stable'
    : status !== 'none_stable'
      ? plainWord(status)
      : (stable_intervals ?? []).length > 0
        ? 'none: the softest walls are unstable, stiffer ones are stable'
        : 'none: no wall is stable, however soft'

/** Who holds the device, always named so. */
export const holderName = { nobody: 'nobody holding', user: 'the file’s user', any_user: 'any passive user' }

/** The limit that a holder leaves. */
export const holderWord = (of: Analysis | null, holder: HolderLimit | null | undefined, told = say): string =>
  !of
    ? ''
    : of.status === 'refused'
      ? 'no number is given'
      : !holder
        ? 'not given'
        : holder === of.limits.any_user && holder.critical_stiffness === 0
          ? 'none: some user destabilises every wall'
          : holder.critical_stiffness
            ? told(holder.critical_stiffness, of.units.stiffness)
            : holder.critical_stiffness === null
              ? 'every wall is stable'
              : holder === of.limits.nobody && of.limits.user
                ? 'none: the softest walls are unstable'
                : limitWord(of)

/** The bounds of the limit with any passive user, of a wall in every direction. */
const boundsWord = ({ point_wall: point, units }: Analysis, told: typeof say): string => {
  const bounds = point?.any_user
  if (!bounds) return 'not known'
  if (bounds.at_least === null) return 'every wall is stable'
  if (bounds.at_least === 0) return 'not known: some user may destabilise every wall'
  const [least, most] = [bounds.at_least, bounds.at_most].map((each) => (each === null ? '' : told(each, units.stiffness)))
  return least === most || !most ? `at least ${least}` : `${least} to ${most}`
}

/** With any passive user: of a wall in every direction bounds are known, else a limit. */
export const anyUserLimitWord = (of: Analysis, told = say): string =>
  of.point_wall && of.status !== 'refused' ? boundsWord(of, told) : holderWord(of, of.limits.any_user, told)

/** What is known of the limit with any passive user: the limit, or of a wall in every direction what is stable at least. */
export const anyUserAtLeast = (of: Analysis): number | null | undefined =>
  of.point_wall ? of.point_wall.any_user?.at_least : of.limits.any_user?.critical_stiffness

/** Where an uncertain limit lies, in 95 %; an end that is null is none. */
export type Interval = readonly [number | null, number | null]
export const intervalWord = (
  [low, high]: Interval,
  unit: string,
  told: (value: number, unit: string, digits: number) => string,
): string => {
  if (low === null) return 'every wall is stable'
  const [from, to] = [told(low, unit, 3), high === null ? '' : told(high, unit, 3)]
  if (to === '') return `${from} or more`
  const [number, same] = from.split(/ (.*)/)
  return from === to ? from : to.endsWith(` ${same}`) ? `${number} to ${to}` : `${from} to ${to}`
}

/** "(−0.93, 0.36, 0)" */
export const directionWord = (direction: number[]): string =>
  `(${direction.map((each) => say(Math.round(each * 1e3) / 1e3 + 0, '').replace('-', '−')).join(', ')})`

/** A wall is one of these, in texts, page and figures. */
export type WallWord = 'stable for anyone' | 'stable alone only' | 'stable alone; any passive user not known' | 'unstable'

/** The verdict on a wall: a person always lets go. */
export const wallWord = ({
  stable,
  stable_for: { any_user: anyUser },
}: Pick<NonNullable<Analysis['wall']>, 'stable' | 'stable_for'>): WallWord =>
  !stable ? 'unstable' : anyUser === null ? 'stable alone; any passive user not known' : anyUser ? 'stable for anyone' : 'stable alone only'

/** That verdict as a figure colours it. */
export const verdictLook = (wall: Pick<NonNullable<Analysis['wall']>, 'stable' | 'stable_for'>): string =>
  !wall.stable ? 'unstable' : wall.stable_for.any_user === true ? 'for-anyone' : 'alone-only'

/** A margin that is null is none, or was left out: then one of these was found. */
const marginsLeftOut = {
  gain: ['left_out_beside_damper_loop'],
  phase: ['margins_contradict', 'point_margins_left_out'],
  delay: ['margins_contradict', 'point_margins_left_out', 'delay_margin_contradicts', 'left_out_beside_damper_loop'],
}
const marginText = (of: Analysis, margin: keyof typeof marginsLeftOut, value: number | null, inUnits: (value: number) => string): string =>
  value !== null ? inUnits(value) : of.findings.some((each) => marginsLeftOut[margin].includes(each.code)) ? 'not known' : 'none'
/** How far a stable wall is from instability, in words; a dash beside one that is not. */
export const marginWord = {
  gain: (of: Analysis): string => (of.wall?.stable ? marginText(of, 'gain', of.wall.gain_margin_db, (db) => `${say(db, '', 3)} dB`) : '–'),
  phase: (of: Analysis): string =>
    of.wall?.stable ? marginText(of, 'phase', of.wall.phase_margin_rad, (phase) => `${say((phase * 180) / Math.PI, '', 3)}°`) : '–',
  delay: (of: Analysis): string => (of.wall?.stable ? marginText(of, 'delay', of.wall.delay_margin_s, (delay) => say(delay, 's', 3)) : '–'),
}

export const isPoorlyDamped = ({ findings }: Pick<Analysis, 'findings'>): boolean =>
  findings.some((each) => each.code === 'wall_poorly_damped')

/** Beside numbers that are not yet those of what the page shows. */
export const stale = 'of the device before; computing …'
export const held = 'of the numbers before the error'

export const plainWord = (word: string | null | undefined): string => (word ?? '–').replaceAll('_', ' ')

export const simulationWord: Record<string, string> = {
  settles: 'It settles.',
  limit_cycle: 'It does not come to rest: a steady oscillation stays.',
  forced: 'It follows the user’s force.',
  unstable: 'UNSTABLE: the oscillation grows.',
  drifts: 'It drifts away.',
  undecided: 'The run is too short or too irregular to tell; simulate longer.',
}

export const causeWord: Record<string, string> = {
  device: 'the device itself, nobody holding',
  device_with_operator: 'the device and the user of the file',
  operator: 'the device and the user of the file',
  passive_user: 'the grasp of a user',
  quantisation: 'the steps of the encoder',
  friction: 'dry friction',
  force_limit: 'the force limit',
}

/** The limit with any passive user after a change; what lowers it is said. */
export const anyUserWord = ({ any_user_then: then, safe }: ForAnyUser, unit: string): string =>
  safe === null ? '–' : `${then === null ? 'no limit' : then === 0 ? 'no wall' : say(then, unit)}${safe ? '' : ', lower than now'}`

/** "13 % lower", "2.5 times higher". */
const movedWord = (factor: number): string => {
  const way = factor < 1 ? 'lower' : 'higher'
  const larger = Math.max(factor, 1 / factor)
  return larger < 2 ? `${say(100 * Math.abs(factor - 1), '', 2)} % ${way}` : `${say(larger, '', 2)} times ${way}`
}

/** What would have to be otherwise for a cause to fit. */
export const otherwiseWord = (factors: { limit: number; frequency: number; amplitude: number }): string => {
  const names = { limit: 'its limit', frequency: 'its frequency', amplitude: 'its swing' } as const
  const parts = (['limit', 'frequency', 'amplitude'] as const)
    .filter((name) => factors[name] !== 1)
    .map((name) => `${names[name]} is ${movedWord(factors[name])}`)
  return `it fits where ${parts.length > 0 ? parts.join(' and ') : 'the user of the file lets go'}`
}

/** The numbers of a fit by inverse dynamics. */
export const rigidBodyWord: Record<string, string> = {
  mass: 'mass',
  viscous: 'damping',
  coulomb: 'dry friction',
  offset: 'constant force',
  delay: 'delay from force to motion',
}

export const glossary: Record<string, string> = {
  'critical stiffness': 'The stiffest wall that the device renders stably.',
  'nobody holding': 'The stiffest wall that the device renders stably when nobody holds it: any stiffer, and it oscillates by itself.',
  'the file’s user':
    'The stiffest wall that stays stable while the user of the device file holds it. A person lets go: build on the lesser.',
  'any passive user': 'The stiffest wall that stays stable whoever holds the device, as long as the hand only takes energy and gives none.',
  'limited by': 'Which motion goes unstable first: the device as one rigid mass, or one of its vibration modes.',
  trust:
    'Sound: data and model carry the number. Doubtful: the number stands, but something it rests on does not carry it. Refused: no number is given.',
  crossover: 'A stiffness and frequency at which the loop just oscillates; the least one usually is the critical stiffness.',
  'gain margin': 'By how much the wall’s whole force may grow before the loop oscillates.',
  'phase margin': 'How much more phase lag the loop bears before it oscillates.',
  'delay margin': 'The least added delay that makes the loop oscillate.',
  'virtual damping': 'The damper that the controller computes from differences of sampled positions.',
  'force per count': 'By how much the force jumps when the encoder counts one step.',
  coherence: 'How much of the motion the force explains at a frequency: 1 all, 0 nothing.',
  yield: 'The share of many units, each drawn by how its numbers vary, that reach the stiffness that every one must.',
  'relay experiment':
    'A switch in place of the wall makes the device oscillate by itself; the swing shows a stiffness, which is not always the limit.',
  sensitivity: 'What the limit gains or loses when the number grows by 10 %, all else as it is, by the slope here.',
}
