import { describe, expect, it } from 'vitest'
import { say } from '../../src/model/decimal'
import { groupsOf, inWords } from '../../src/model/keys'
import { scan } from '../../src/model/toml'
import { asListed, intervalWord, limitWord, remarkLine, wallWord } from '../../src/model/words'

const finding = (text: string) => ({
  code: 'stated',
  severity: 'doubt' as const,
  key: null,
  evidence: {},
  effect: null,
  remedy: '',
  text,
})

describe('findings', () => {
  it('stand in the order of the document, each once', () => {
    const findings = ['b', 'c; d', 'a'].map(finding)
    expect(asListed(['a', 'b', 'b'], findings, (each) => each)).toEqual(['b', 'a'])
    const remarks = ['b', 'e', 'c'].map((what) => ({ severity: 'note', what, consequence: '', remedy: what === 'c' ? 'd' : '' }))
    expect(asListed(remarks, findings, remarkLine).map((each) => each.what)).toEqual(['b', 'c'])
  })
})

describe('words', () => {
  it('say what is stable where there is no limit', () => {
    expect(limitWord({ status: 'none_stable', stable_intervals: [] })).toBe('none: no wall is stable, however soft')
    expect(limitWord({ status: 'none_stable', stable_intervals: null })).toBe('none: no wall is stable, however soft')
    expect(limitWord({ status: 'none_stable', stable_intervals: [[500, 2000]] })).toBe(
      'none: the softest walls are unstable, stiffer ones are stable',
    )
    expect(limitWord({ status: 'unbounded', stable_intervals: [[0, null]] })).toBe('every wall is stable')
    expect(limitWord({ status: 'refused', stable_intervals: null })).toBe('refused')
  })

  it('call a wall stable alone only where some user is known to destabilise it', () => {
    const word = (stable: boolean, anyUser: boolean | null): string =>
      wallWord({ stable, stable_for: { nobody: stable, user: null, any_user: anyUser } })
    expect(word(true, true)).toBe('stable for anyone')
    expect(word(true, false)).toBe('stable alone only')
    expect(word(true, null)).toBe('stable alone; any passive user not known')
    expect(word(false, null)).toBe('unstable')
  })

  it('say where an uncertain limit lies', () => {
    const word = (low: number | null, high: number | null): string => intervalWord([low, high], 'N/m', say)
    expect(word(2000, 31_000)).toBe('2 to 31 kN/m')
    expect(word(900, 3100)).toBe('900 N/m to 3.1 kN/m')
    expect(word(2000, null)).toBe('2 kN/m or more')
    expect(word(null, null)).toBe('every wall is stable')
    expect(word(2000, 2000)).toBe('2 kN/m')
  })

  it('name numbers as the page does, in the texts of the program', () => {
    const groups = groupsOf(
      scan(
        'motion = "rotary"\n[[body]]\nname = "a"\ninertia = 1\n[[body]]\nname = "a b"\ninertia = 1\n[[link]]\nbetween = ["a", "a b"]\nstiffness = 1\n[loop]\nsampling_period = 1e-3\n',
      ),
    )
    expect(inWords('the data do not determine body.a b.mass, link.0.damping, body.a.damping: taken as they stand', groups)).toBe(
      'the data do not determine Body “a b”: inertia, Link a – a b: damping, Body “a”: damping: taken as they stand',
    )
    expect(inWords('free loop.delay, or give it', groups)).toBe('free Loop: delay, or give it')
    expect(inWords('rate 1000 Hz: read in units of 1 s', groups)).toBe('rate 1000 Hz: read in units of 1 s')
  })
})
