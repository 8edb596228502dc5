import { describe, expect, it } from 'vitest'
import { placeLabels } from '../../src/chart/labels'
import { csvOf } from '../../src/chart/save'
import { axisUnit, bandOf, extent, pathOf, pixel, roundEnd, ticks, valueAt, type Scale } from '../../src/chart/scale'
import { setsFrom } from '../../src/model/commands'

const linear: Scale = { log: false, from: 0, to: 10, start: 50, end: 450 }
const log: Scale = { log: true, from: 1, to: 1e4, start: 300, end: 10 }

describe('scale', () => {
  it('goes to pixels and back', () => {
    for (const [scale, values] of [
      [linear, [0, 3, 10]],
      [log, [1, 77, 1e4]],
    ] as const) {
      for (const value of values) expect(valueAt(scale, pixel(scale, value))).toBeCloseTo(value, 9)
    }
  })

  it('ticks round numbers within the axis', () => {
    expect(ticks(linear, 5)).toEqual([0, 2, 4, 6, 8, 10])
    expect(ticks(log, 5)).toEqual([1, 10, 100, 1000, 10000])
    for (const value of ticks({ ...linear, from: -1e-7, to: 3e-7 }, 4)) expect(String(value).length).toBeLessThan(8)
  })

  it('names one unit per axis', () => {
    const kilo = axisUnit({ ...linear, to: 25e3 }, 'N/m')
    expect([kilo.text, kilo.number(5000)]).toEqual(['kN/m', '5'])
    const milli = axisUnit({ ...linear, from: -2e-3, to: 1e-3 }, 'm')
    expect([milli.text, milli.number(-1.5e-3)]).toEqual(['mm', '-1.5'])
    expect(axisUnit(linear, '').text).toBe('')
  })

  it('ends at round numbers', () => {
    expect([roundEnd(3, false), roundEnd(3, true), roundEnd(5000, true), roundEnd(0.07, true), roundEnd(2e-4, false)]).toEqual([
      2, 5, 5000, 0.1, 2e-4,
    ])
  })

  it('covers the values, whatever is missing', () => {
    expect(extent([3, null, 97, undefined, NaN], false)).toEqual([0, 100])
    expect(extent([], true)).toEqual([1, 10])
    expect(extent([5], false)[0]).toBeLessThan(5)
    expect(extent([0, -1, 10, 1000], true)).toEqual([10, 1000])
  })

  it('breaks a curve where there is no number, and keeps every peak of a dense one', () => {
    expect(pathOf([1, 2, 3, 4], [1, null, 2, 3], linear, { ...linear, start: 100, end: 0 }).match(/M/g)).toHaveLength(2)
    const xs = Array.from({ length: 100_000 }, (_, i) => i / 10_000)
    const ys = xs.map((_, i) => (i === 54_321 ? 9 : 1))
    const path = pathOf(xs, ys, linear, { ...linear, start: 100, end: 0 })
    expect(path).toMatch(/ 10(L|$)/)
    expect(path.length).toBeLessThan(100_000)
  })

  it('leaves out what lies on the line between its neighbours, and no more', () => {
    const upright: Scale = { log: false, from: -1, to: 1, start: 200, end: 10 }
    const cornersOf = (path: string): [number, number][] =>
      [...path.matchAll(/[ML](\S+) ([^ML]+)/g)].map(([, x, y]) => [Number(x), Number(y)])
    /** Of a point from the drawn curve. */
    const farFrom = (corners: [number, number][], [px, py]: [number, number]): number =>
      Math.min(
        ...corners.slice(1).map(([bx, by], i) => {
          const [ax, ay] = corners[i]!
          const square = (bx - ax) ** 2 + (by - ay) ** 2
          const share = square > 0 ? Math.min(1, Math.max(0, ((px - ax) * (bx - ax) + (py - ay) * (by - ay)) / square)) : 0
          return Math.hypot(px - ax - share * (bx - ax), py - ay - share * (by - ay))
        }),
      )
    const xs = Array.from({ length: 20_000 }, (_, i) => i / 2000)
    const curves = [
      (x: number) => Math.exp(-x / 2) * Math.sin(20 * x), // rings down
      (x: number) => 0.8 * Math.sin(3 * x) + 0.1 * Math.sin(31 * x),
      (x: number) => 1e-3 * x, // straight
      (x: number) => (x < 4 ? 0 : x < 6 ? 0.5 * (x - 4) : 1), // with corners
      (x: number) => 2 / (1 + Math.exp(40 * (x - 5))) - 1, // steep
    ]
    for (const [which, curve] of curves.entries()) {
      const corners = cornersOf(pathOf(xs, xs.map(curve), linear, upright))
      expect(corners.length, `curve ${which}`).toBeLessThan(900)
      const far = Math.max(
        ...xs
          .filter((_, i) => i % 97 === 0 || i === xs.length - 1)
          .map((x) => farFrom(corners, [pixel(linear, x), pixel(upright, curve(x))])),
      )
      expect(far, `curve ${which}`).toBeLessThan(0.3)
    }
    // There and back along one line: both ends stay.
    const back: Scale = { ...linear, start: 0, end: 100 }
    expect(cornersOf(pathOf([0, 5, 9, 4, 1], [0, 0, 0, 0, 0], back, upright)).map(([x]) => x)).toEqual([0, 90, 10])
    // One that buzzes keeps the lowest and the highest of each column.
    const buzz = xs.map((_, i) => (i % 2 === 0 ? 0.6 : -0.6) * (1 + (i % 5) / 50))
    const corners = cornersOf(pathOf(xs, buzz, linear, upright))
    expect(corners.length).toBeGreaterThan(1500)
    const far = Math.max(
      ...xs.filter((_, i) => i % 97 === 0).map((x, i) => farFrom(corners, [pixel(linear, x), pixel(upright, buzz[97 * i]!)])),
    )
    expect(far).toBeLessThan(0.6) // as wide as a column
  })
})

describe('labels of marks', () => {
  const within = { left: 52, right: 360, top: 0, bottom: 196 }
  it('stand beside their marks, and none over another or over a mark', () => {
    const points = [
      [200, 100],
      [206, 103],
      [212, 98],
      [340, 20],
      [345, 12],
    ].map(([x, y], i) => ({ x: x!, y: y!, label: `${i}5.8 kN/m` }))
    const places = placeLabels(points, within)
    const boxes = places.map((place, i) => {
      const width = points[i]!.label.length * 6.4
      return {
        left: place!.anchor === 'start' ? place!.x : place!.x - width,
        right: place!.anchor === 'start' ? place!.x + width : place!.x,
        top: place!.y - 10,
        bottom: place!.y + 3,
      }
    })
    for (const [i, a] of boxes.entries()) {
      expect(a.left >= within.left && a.right <= within.right && a.top >= within.top && a.bottom <= within.bottom).toBe(true)
      for (const b of boxes.slice(i + 1))
        expect(a.left >= b.right || a.right <= b.left || a.top >= b.bottom || a.bottom <= b.top).toBe(true)
    }
    expect(places[0]).toEqual({ x: 193, y: 94, anchor: 'end' })
  })

  it('leave out what has no place', () => {
    expect(
      placeLabels([{ x: 60, y: 10, label: 'far too long for so narrow a plot as this' }], { left: 52, right: 100, top: 0, bottom: 40 }),
    ).toEqual([null])
  })
})

describe('a band', () => {
  const y: Scale = { log: false, from: 0, to: 10, start: 100, end: 0 }
  it('is one closed piece per run, down to the axis where it has no lower end', () => {
    // x 0 to 4: pixels 50, 90, ... ; the lower end of the third is none, the fourth is not measured at all.
    expect(bandOf([0, 1, 2, 3, 4], [1, 2, null, null, 3], [3, 4.5, 5, null, 6], linear, y)).toBe(
      'M50 90L90 80L130 100L130 50L90 55L50 70ZM210 70L210 40Z',
    )
  })
})

describe('out of the page', () => {
  it('writes CSV that others read', () => {
    expect(
      csvOf({
        head: ['a, b', 'c'],
        rows: [
          [1.5, null],
          ['say "x"', 2],
        ],
      }),
    ).toBe('"a, b",c\n1.5,\n"say ""x""",2\n')
  })

  it('finds what --set makes of an example', () => {
    const example = 'name = "x"\nmotion = "linear"\n[[body]]\nname = "a"\nmass = 1.0\n[loop]\nsampling_period = 1e-3\n'
    expect(setsFrom(example, example)).toEqual([])
    expect(setsFrom(example, example.replace('1e-3', '0.001'))).toEqual([])
    expect(setsFrom(example, example.replace('mass = 1.0', 'mass = "3 lb"\ncoulomb = 0.5\ndamping = 0.0'))).toEqual([
      'body.a.mass=3 lb',
      'body.a.coulomb=0.5',
    ])
    expect(setsFrom(example, `${example}[wall]\nstiffness = 0.0\n`)).toEqual(['wall.stiffness=0.0'])
    expect(setsFrom(example, example.replace('"x"', '"y"'))).toBeNull()
    expect(setsFrom(example, example.replace('[loop]\nsampling_period = 1e-3\n', ''))).toBeNull()
  })
})
