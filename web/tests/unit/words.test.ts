import { describe, expect, it } from 'vitest'
import { limitWord } from '../../src/model/words'

describe('words', () => {
  it('say what is stable where there is no limit', () => {
    expect(limitWord({ status: 'none_stable', stable_intervals: [] })).toBe('none: no wall is stable, however soft')
    expect(limitWord({ status: 'none_stable', stable_intervals: null })).toBe('none: no wall is stable, however soft')
    expect(limitWord({ status: 'none_stable', stable_intervals: [[500, 2000]] })).toBe('none: the softest walls are unstable, stiffer ones are stable')
    expect(limitWord({ status: 'unbounded', stable_intervals: [[0, null]] })).toBe('every wall is stable')
    expect(limitWord({ status: 'refused', stable_intervals: null })).toBe('refused')
  })
})
