import { describe, expect, it } from 'vitest'
import { groupsOf, inWords } from '../../src/model/keys'
import { scan } from '../../src/model/toml'
import { limitWord, warningsFirst, worstFirst } from '../../src/model/words'

const finding = (text: string, severity: 'doubt' | 'refusal', limit: number | null = null) => ({
  code: 'stated',
  severity,
  key: null,
  evidence: {},
  effect: limit === null ? null : { critical_stiffness: limit },
  remedy: '',
  text,
})

describe('findings', () => {
  it('come with refusals first, then the lowest limit, then as they were found', () => {
    const found = [finding('a', 'doubt'), finding('b', 'doubt', 800), finding('c', 'doubt', 500), finding('d', 'refusal')]
    expect(worstFirst(['a', 'b', 'no finding', 'c', 'd'], found)).toEqual(['d', 'c', 'b', 'a', 'no finding'])
  })

  it('come with warnings before notes', () => {
    const remarks = ['note', 'warning', 'note'].map((severity, i) => ({ severity, what: String(i), consequence: '', remedy: '' }))
    expect(warningsFirst(remarks).map((each) => each.what)).toEqual(['1', '0', '2'])
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
