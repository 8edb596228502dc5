// From where to where an axis shows its values, as somebody zooms and moves it.

import { valueAt, type Scale } from './scale'

export type Range = [from: number, to: number]

/** As it is measured along the axis. */
const along = (value: number, log: boolean): number => (log ? Math.log(value) : value)
const back = (value: number, log: boolean): number => (log ? Math.exp(value) : value)
const length = ([from, to]: Range, log: boolean): number => along(to, log) - along(from, log)

export const union = (a: Range, b: [] | Range): Range => (b.length === 0 ? a : [Math.min(a[0], b[0]), Math.max(a[1], b[1])])
/** Whether any of it is on the axis; of a logarithm it must be above 0. */
export const isOn = ([from, to]: Range, whole: Range, log: boolean): boolean => from < whole[1] && to > whole[0] && (!log || from > 0)

const least = 1e-6 // of the whole, which is as near as one may go

/** No more than the whole, and within it. */
function within(range: Range, whole: Range, log: boolean): Range {
  const [low, high] = [along(whole[0], log), along(whole[1], log)]
  const size = Math.min(high - low, length(range, log))
  const from = Math.min(Math.max(along(range[0], log), low), high - size)
  return [back(from, log), back(from + size, log)]
}

/** `factor` times as much, with the value at that pixel where it is. */
export function zoomed(scale: Scale, at: number, factor: number, whole: Range): Range {
  const of = (end: number): number => valueAt(scale, at + (end - at) * factor)
  const next: Range = [of(scale.start), of(scale.end)]
  const isTooNear = length(next, scale.log) < least * length(whole, scale.log)
  return within(isTooNear ? [scale.from, scale.to] : next, whole, scale.log)
}

/** Moved by so many pixels. */
export const moved = (scale: Scale, by: number, whole: Range): Range =>
  within([valueAt(scale, scale.start - by), valueAt(scale, scale.end - by)], whole, scale.log)

/** Whether it shows as much as the other or more, but for rounding. */
export const isAsWide = (range: Range, other: Range, log: boolean): boolean => length(range, log) > length(other, log) * (1 - 1e-6)
