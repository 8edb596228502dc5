export interface Series {
  name: string
  means?: string // in the legend, beside its name
  x: readonly number[]
  y: readonly (number | null)[]
  look: number // colour and dashes
  filled?: boolean
  band?: { low: readonly (number | null)[]; high: readonly (number | null)[] }
  dots?: boolean
  thin?: boolean
}

export interface Mark {
  x: number
  y: number
  label: string
  shape: 'dot' | 'ring' | 'cross'
}

export interface Axis {
  label: string
  unit: string
  log?: boolean
  range?: [number, number]
  shared?: string // with the figures whose axis has that name: one cursor, one range
}

/** A line across, with what lies beyond it. */
export interface Level {
  y: number
  label: string
}

/** A part of the x axis that is chosen by a drag; an end that is null is that of the axis. */
export interface Selection {
  from: number | null
  to: number | null
  choose: (from: number, to: number) => void
}

/** A point that is dragged, or moved with the arrow keys. */
export interface Handle {
  x: number
  y: number
  label: string
  text: string
  locked?: boolean
  look?: string // its colour, as a class
  move: (x: number, y: number, gesture: string) => void
  key?: (event: KeyboardEvent) => void
  end: () => void
}
