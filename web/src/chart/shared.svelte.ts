// What figures of one axis have in common: where the cursor is on it, and from where to where they show it.
import type { Range } from './range'

export class SharedAxis {
  cursor = $state<number | null>(null)
  range = $state.raw<Range | null>(null) // null: as the figure fits it
}
const all = new Map<string, SharedAxis>()

/** The axis of that name; every figure has one of its own without. */
export function axisOf(name: string | undefined): SharedAxis {
  const known = name === undefined ? undefined : all.get(name)
  const axis = known ?? new SharedAxis()
  if (name !== undefined && !known) all.set(name, axis)
  return axis
}
