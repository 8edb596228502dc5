/** All that a link shares: the design, the pinned ones, what is locked, and what the panels were asked. */
export interface Snapshot {
  toml: string
  pins: Pin[]
  locks: string[] // keys
  settings: Settings
}

export interface Pin {
  name: string
  toml: string
}

/** Of the panels; what is absent is the server's own default. Texts are as typed, so that the server judges them. */
export interface Settings {
  contact?: 'unilateral'
  duration?: string
  userForce?: string
  approach?: string // speed
  relayAmplitude?: string
  oscillatesHz?: string
  target?: string
  targetAnyUser?: boolean
  sweep?: string // key
  sweepFrom?: string
  sweepTo?: string
  gainMarginDb?: string
  phaseMarginDeg?: string
  ripple?: string
  goal?: string
  studySpreads?: string // JSON of what varies
  studyStiffness?: string
  studyAnyUser?: string
  studySamples?: string
  workspacePoses?: string
  workspaceNormals?: string
  workspaceStiffness?: string
}

export const empty = (toml: string): Snapshot => ({ toml, pins: [], locks: [], settings: {} })
