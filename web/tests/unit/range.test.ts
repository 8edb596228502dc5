import { describe, expect, it } from 'vitest'
import { isAsWide, isOn, moved, union, zoomed, type Range } from '../../src/chart/range'
import { pixel, valueAt, type Scale } from '../../src/chart/scale'

/** The same numbers each time. */
function* random(seed: number): Generator<number, never> {
  for (let state = seed; ; ) {
    state = (state * 1103515245 + 12345) % 2147483648
    yield state / 2147483648
  }
}

describe('the range of an axis', () => {
  const next = random(48)
  const draw = (): number => next.next().value
  const cases = Array.from({ length: 300 }, () => {
    const log = draw() < 0.5
    const from = log ? 10 ** (6 * draw() - 3) : 200 * draw() - 100
    const to = log ? from * (1.5 + 1000 * draw()) : from + 0.1 + 100 * draw()
    const isUpright = draw() < 0.5
    const scale: Scale = { log, from, to, start: isUpright ? 300 : 50, end: isUpright ? 10 : 450 }
    const at = scale.start + draw() * (scale.end - scale.start)
    return { scale, at, whole: [from, to] as Range, factor: 0.1 + 0.9 * draw() }
  })

  it('keeps the value under the pointer where it is', () => {
    for (const { scale, at, whole, factor } of cases) {
      const [from, to] = zoomed(scale, at, factor, whole)
      expect(pixel({ ...scale, from, to }, valueAt(scale, at))).toBeCloseTo(at, 4)
    }
  })

  it('comes back to all of it, and shows no more', () => {
    for (const { scale, at, whole, factor } of cases) {
      const [from, to] = zoomed(scale, at, factor, whole)
      const [low, high] = zoomed({ ...scale, from, to }, at, 1 / factor, whole)
      expect(isAsWide([low, high], whole, scale.log)).toBe(true)
      for (const [found, sought] of [
        [low, whole[0]],
        [high, whole[1]],
      ] as const)
        expect(Math.abs(pixel(scale, found) - pixel(scale, sought))).toBeLessThan(1e-3)
      const beyond = zoomed(scale, at, 5, whole)
      expect(Math.abs(pixel(scale, beyond[0]) - scale.start) + Math.abs(pixel(scale, beyond[1]) - scale.end)).toBeLessThan(1e-3)
    }
  })

  it('moves with the hand, and stops at the ends', () => {
    for (const { scale, at, whole, factor } of cases) {
      const [from, to] = zoomed(scale, at, factor / 2, whole)
      const near = { ...scale, from, to }
      const far = moved(near, 1e4 * Math.sign(scale.end - scale.start), whole)
      expect(pixel(scale, far[0])).toBeCloseTo(scale.start, 3)
      const back = moved({ ...near, from: far[0], to: far[1] }, -7 * Math.sign(scale.end - scale.start), whole)
      expect(
        Math.abs(pixel({ ...near, from: back[0], to: back[1] }, far[0]) - (scale.start - 7 * Math.sign(scale.end - scale.start))),
      ).toBeLessThan(1e-3)
    }
  })

  it('goes no nearer than numbers have digits', () => {
    let range: Range = [0, 1]
    for (let i = 0; i < 1000; ++i) range = zoomed({ log: false, from: range[0], to: range[1], start: 0, end: 100 }, 33, 0.5, [0, 1])
    expect(range[1] - range[0]).toBeGreaterThan(1e-7)
  })

  it('joins and compares ranges', () => {
    expect(union([1, 2], [])).toEqual([1, 2])
    expect(union([1, 2], [0, 1.5])).toEqual([0, 2])
    expect([isOn([3, 4], [1, 2], false), isOn([1.5, 4], [1, 2], false), isOn([-1, 4], [1, 2], true)]).toEqual([false, true, false])
  })
})
