// The program's answer for a workspace as the page shows it: where the tip is, and the least limit there.

import type { Workspace, WorkspacePose } from '../api/documents'
import { say, siOfPosition } from './decimal'
import type { Joint } from './keys'

/** Limits are with any passive user where the program knows them. */
export const isAnyUser = (of: Workspace): boolean => of.least_any_user !== null

export interface Spot {
  index: number // of the poses
  tip: number[]
  limit: number | null // null: every wall is stable
}

/** Poses that the tip reaches and whose limit is known, the least last: it is drawn on top. */
export function spotsOf(of: Workspace): Spot[] {
  const spots = of.poses.flatMap((pose, index): Spot[] => {
    const limit = isAnyUser(of) ? pose.least_any_user : pose.least
    return pose.tip && limit ? [{ index, tip: pose.tip, limit: limit.value }] : []
  })
  return spots.sort((a, b) => (b.limit ?? Infinity) - (a.limit ?? Infinity))
}

/** In which two of the world's axes the tip moves most. */
export function widestView(tips: number[][]): [number, number] {
  const extents = [0, 1, 2].map((axis) => extentOf(tips, axis)).map(([low, high]) => high - low)
  const least = [2, 1, 0].reduce((best, axis) => (extents[axis]! < extents[best]! ? axis : best))
  return least === 2 ? [0, 1] : least === 1 ? [0, 2] : [1, 2]
}

export function extentOf(tips: number[][], axis: number): [number, number] {
  let [low, high] = [Infinity, -Infinity]
  for (const tip of tips) {
    low = Math.min(low, tip[axis]!)
    high = Math.max(high, tip[axis]!)
  }
  return low > high ? [-0.1, 0.1] : [low, high]
}

/** "shoulder 17.2°, slide 20 mm" */
export const poseText = (of: Workspace, positions: (number | null)[]): string =>
  of.joints
    .map(({ name, unit }, i) => {
      const at = positions[i]
      if (at === null || at === undefined) return `${name} –`
      const text = unit === 'rad' ? `${say(at / siOfPosition('deg')!, '', 4)}°` : say(at, unit)
      return `${name} ${text.replace('-', '−')}`
    })
    .join(', ')

export const positionsOf = (of: Workspace, positions: (number | null)[]): Record<string, number> =>
  Object.fromEntries(of.joints.flatMap(({ name }, i) => (typeof positions[i] === 'number' ? [[name, positions[i]]] : [])))

/** What the limit is in every direction of a plane at a pose, around it: shares of the greatest, both ways along each normal. */
export function curveOf(pose: WorkspacePose, anyUser: boolean, [across, up]: [number, number]): [number, number][] {
  const around = (pose.directions ?? []).flatMap(({ normal, nobody, any_user, status }): { angle: number; limit: number }[] => {
    const limit = anyUser ? any_user : nobody
    const known = limit ?? (status === 'unbounded' ? Infinity : null)
    const angle = Math.atan2(normal[up]!, normal[across]!)
    return known === null ? [] : [{ angle: angle < 0 ? angle + Math.PI : angle, limit: known }]
  })
  const greatest = Math.max(...around.map(({ limit }) => limit).filter(Number.isFinite))
  if (around.length < 3 || !(greatest > 0)) return []
  const half = around
    .sort((a, b) => a.angle - b.angle)
    .map(({ angle, limit }): [number, number] => {
      const share = Math.min(1, limit / greatest)
      return [share * Math.cos(angle), share * Math.sin(angle)]
    })
  return [...half, ...half.map(([x, y]): [number, number] => [-x, -y])]
}

const countsOfGrid = [1, 60, 15, 7, 4]
/** A coarse grid over the ranges of the joints; null where one of them has none: what to look at then only its user knows. */
export function gridOf(joints: Joint[]): string | null {
  const count = countsOfGrid[joints.length] ?? 3
  const parts = joints.map(({ name, range }) => {
    const [from, to] = range ?? []
    return from === undefined || to === undefined ? null : `${name}=${Number(from.toPrecision(6))}:${Number(to.toPrecision(6))}:${count}`
  })
  return joints.length === 0 || parts.includes(null) ? null : parts.join(',')
}
/** The same as somebody would write it of joints without ranges. */
export const gridExample = (joints: Joint[]): string =>
  joints.map(({ name, unit }) => `${name}=${unit === 'm' ? '0:100:15 mm' : '-90:90:15 deg'}`).join(',')
