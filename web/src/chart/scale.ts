// Axes: from values to pixels and back, and where the ticks stand.

import { shifted, shown } from '../model/decimal'

export interface Scale {
  log: boolean
  from: number
  to: number
  start: number // pixels
  end: number
}

export const pixel = (scale: Scale, value: number): number => {
  const share = scale.log
    ? (Math.log(value) - Math.log(scale.from)) / (Math.log(scale.to) - Math.log(scale.from))
    : (value - scale.from) / (scale.to - scale.from)
  return scale.start + share * (scale.end - scale.start)
}

export const valueAt = (scale: Scale, at: number): number => {
  const share = (at - scale.start) / (scale.end - scale.start)
  return scale.log ? scale.from * (scale.to / scale.from) ** share : scale.from + share * (scale.to - scale.from)
}

/** The next 1, 2 or 5 times a power of ten, below or above: an axis whose ends move seldom is read more easily. */
export function roundEnd(value: number, above: boolean): number {
  const power = Math.floor(Math.log10(value))
  const steps = [1, 2, 5, 10].map((step) => Number(`${step}e${power}`))
  return (above ? steps.find((each) => each >= value * 0.999999) : steps.findLast((each) => each <= value * 1.000001)) ?? value
}

/** The least and the greatest of the values that an axis can show; empty where there is none. */
export function ends(values: Iterable<number | null | undefined>, log: boolean): [] | [number, number] {
  let low = Infinity
  let high = -Infinity
  for (const value of values) {
    if (value === null || value === undefined || !Number.isFinite(value) || (log && value <= 0)) continue
    if (value < low) low = value
    if (value > high) high = value
  }
  return low > high ? [] : [low, high]
}

/** The ends of an axis that shows all values: whole decades' parts on a logarithm, round numbers else. */
export function extent(values: Iterable<number | null | undefined>, log: boolean): [number, number] {
  let [low, high] = ends(values, log)
  if (low === undefined || high === undefined) return log ? [1, 10] : [0, 1]
  if (log) {
    return [low === high ? low / 3 : low, low === high ? high * 3 : high]
  }
  if (low === high) [low, high] = low === 0 ? [-1, 1] : [low - Math.abs(low) / 2, high + Math.abs(high) / 2]
  const step = niceStep((high - low) / 8)
  return [Math.floor(low / step + 1e-9) * step, Math.ceil(high / step - 1e-9) * step]
}

function niceStep(raw: number): number {
  const power = 10 ** Math.floor(Math.log10(raw))
  const factor = raw / power
  return (factor <= 1 ? 1 : factor <= 2 ? 2 : factor <= 5 ? 5 : 10) * power
}

export function ticks(scale: Scale, about: number): number[] {
  if (!scale.log) {
    const step = niceStep(Math.abs(scale.to - scale.from) / about)
    const first = Math.ceil(Math.min(scale.from, scale.to) / step - 1e-9)
    const last = Math.floor(Math.max(scale.from, scale.to) / step + 1e-9)
    return Array.from({ length: Math.max(0, last - first + 1) }, (_, i) => Number(((first + i) * step).toPrecision(12)))
  }
  const decades = Math.log10(scale.to / scale.from)
  const parts = decades <= 1.2 ? [1, 2, 3, 5, 7] : decades * 3 <= about * 1.5 ? [1, 2, 5] : [1]
  const every = Math.max(1, Math.ceil(decades / about))
  const found: number[] = []
  for (let power = Math.floor(Math.log10(scale.from)); power <= Math.ceil(Math.log10(scale.to)); ++power) {
    if (power % every !== 0) continue
    for (const part of parts) {
      const value = Number(`${part}e${power}`)
      if (value >= scale.from * 0.999999 && value <= scale.to * 1.000001) found.push(value)
    }
  }
  return found
}

/** One prefix for all ticks of an axis: that of its largest number, of a logarithm's middle. */
export interface AxisUnit {
  text: string // "kN/m"
  number: (tick: number) => string
}
export function axisUnit(scale: Scale, unit: string): AxisUnit {
  const typical = scale.log ? Math.sqrt(scale.from * scale.to) : Math.max(Math.abs(scale.from), Math.abs(scale.to))
  const { unit: text, places } = shown(typical, unit, 3)
  return { text, number: (tick) => shifted(String(Number(tick.toPrecision(6))), -places) }
}

type Point = [number, number]

/** Squared, from a point to the straight piece between two others. */
function apart([px, py]: Point, [ax, ay]: Point, [bx, by]: Point): number {
  const [dx, dy] = [bx - ax, by - ay]
  const square = dx * dx + dy * dy
  const share = square > 0 ? Math.min(1, Math.max(0, ((px - ax) * dx + (py - ay) * dy) / square)) : 0
  return (px - ax - share * dx) ** 2 + (py - ay - share * dy) ** 2
}

const straight = 0.2 // pixels that a corner which is left out may lie beside the line
const mostLeftOut = 64 // in a row: the time that a straight curve takes stays in proportion to its points

/**
 * An SVG path through the points; of many in one pixel column only first, lowest, highest and last, and none of these that lies on the
 * line between those beside it.
 */
export function pathOf(xs: readonly number[], ys: readonly (number | null)[], x: Scale, y: Scale): string {
  const parts: string[] = []
  let column = NaN
  let inColumn: Point[] = []
  let corner: Point | null = null // the last that is drawn
  let onWay: Point[] = [] // after it
  const draw = (point: Point): void => {
    parts.push((corner ? 'L' : 'M') + Math.round(point[0] * 10) / 10 + ' ' + Math.round(point[1] * 10) / 10)
    corner = point
    onWay = []
  }
  const put = (point: Point): void => {
    if (!corner) return draw(point)
    const isCorner = onWay.length === mostLeftOut || onWay.some((each) => apart(each, corner!, point) > straight ** 2)
    if (isCorner) draw(onWay.at(-1)!)
    onWay.push(point)
  }
  const endPiece = (): void => {
    if (onWay.length > 0) draw(onWay.at(-1)!)
    corner = null
  }
  const flush = (): void => {
    if (inColumn.length === 0) return
    let low = 0
    let high = 0
    if (inColumn.length === 1) {
      put(inColumn[0]!)
      inColumn = []
      return
    }
    for (let i = 1; i < inColumn.length; ++i) {
      if (inColumn[i]![1] < inColumn[low]![1]) low = i
      if (inColumn[i]![1] > inColumn[high]![1]) high = i
    }
    for (const i of [...new Set([0, low, high, inColumn.length - 1])].sort((a, b) => a - b)) {
      put(inColumn[i]!)
    }
    inColumn = []
  }
  for (let i = 0; i < xs.length; ++i) {
    const value = ys[i]
    const px = pixel(x, xs[i]!)
    const py = value === null || value === undefined ? NaN : pixel(y, value)
    if (!Number.isFinite(px) || !Number.isFinite(py)) {
      flush()
      endPiece()
      continue
    }
    if (Math.floor(px * 2) !== column) flush()
    column = Math.floor(px * 2)
    inColumn.push([px, Math.max(-1e5, Math.min(1e5, py))])
  }
  flush()
  endPiece()
  return parts.join('')
}

/** The area between two curves, a closed piece for each run of upper values; a lower one that is none lies below the axis. */
export function bandOf(
  xs: readonly number[],
  low: readonly (number | null)[],
  high: readonly (number | null)[],
  x: Scale,
  y: Scale,
): string {
  let path = ''
  for (let start = 0; start < xs.length; ++start) {
    if (typeof high[start] !== 'number') continue
    let end = start
    while (end < xs.length && typeof high[end] === 'number') ++end
    const run = xs.slice(start, end)
    const lower = pathOf(
      run,
      low.slice(start, end).map((each) => each ?? y.from),
      x,
      y,
    )
    path += `${lower}${pathOf([...run].reverse(), high.slice(start, end).reverse(), x, y).replace(/^M/, 'L')}Z`
    start = end
  }
  return path
}
