// The server's documents as the page calls them. Their types are made of docs/schemas by scripts/documents.mjs: what a key means, and its
// unit, stands beside it there.
import type * as made from './generated/documents'

export type {
  Analysis,
  Bode,
  Diagnosis,
  Finding,
  Region,
  Relay,
  Rival,
  Remark,
  Simulation,
  Study,
  HolderLimit,
  Mechanism as LimitedBy,
  Trust,
  WallPoint,
  WallToRender,
  Workspace,
  WorkspacePose,
} from './generated/documents'
export type { Design, DesignSweep as Sweep, DesignTarget as Target, WallRecommendation as Recommendation } from './generated/documents'

/** What a proposal does to the limit with any passive user. */
export type ForAnyUser = Pick<made.DesignTarget['targets'][number], 'any_user_then' | 'safe'>
/** A recommended wall, or an alternative to it. */
export type Option = made.Alternative | (made.WallRecommendation & { what: string })
/** The answer to --points. */
export type FrequencyResponse = made.Frf & Required<Pick<made.Frf, ColumnOfResponse>>
type ColumnOfResponse = 'frequency_hz' | 'magnitude' | 'magnitude_lower' | 'magnitude_upper' | 'phase_rad' | 'coherence'
/** What an upload answers. */
export type Recording = made.Recording & { id: string }
/** Of a recording, or of inverse dynamics, which have no units and state no limit but how much force stays unexplained. */
export type Identification = Omit<made.Identification, 'units'> &
  Partial<Pick<made.Identification, 'units'> & Pick<made.InverseDynamics, 'relative_residual'>>

export interface Example {
  file: string
  name: string
  opened: boolean
  device_toml: string
}
