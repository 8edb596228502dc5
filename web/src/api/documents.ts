// What the page reads of the server's documents; docs/*_json.md and docs/*.md describe them in full.

export interface Trust {
  verdict: 'sound' | 'doubtful' | 'refused'
  reasons: string[]
}
export interface Remark {
  severity: string
  what: string
  consequence: string
  remedy: string
}
/** What trust and remarks are written from, each once: docs/findings.md. */
export interface Finding {
  code: string
  severity: 'note' | 'doubt' | 'refusal'
  key: string | null
  evidence: Record<string, number | null>
  effect: Record<string, number | null> | null
  remedy: string
  text: string
}
export interface LimitedBy {
  kind: 'rigid_body' | 'vibration_mode'
  mode?: number
}
export interface Crossover {
  frequency_rad_s: number
  frequency_hz: number
  stiffness: number
  stiffness_db: number
  limited_by: LimitedBy | null
  poles_leaving?: number
}
/** null: no limit, or none is given. */
export interface HolderLimit {
  critical_stiffness: number | null
  frequency_rad_s: number | null
  limited_by: LimitedBy | null
  critical_damping: number | null
}
export interface StableFor {
  nobody: boolean
  user: boolean | null
  any_user: boolean | null
}
export interface Margins {
  stable: boolean
  gain_margin_db: number | null
  phase_margin_rad: number | null
  delay_margin_s: number | null
}
interface Judged {
  device: string
  units: { stiffness: string; damping: string }
  trust: Trust
  remarks: Remark[]
  findings: Finding[]
}
export interface Analysis extends Judged {
  status: 'finite' | 'none_stable' | 'unbounded' | 'refused'
  critical_stiffness: number | null
  critical_stiffness_db: number | null
  critical_frequency_hz: number | null
  limited_by: LimitedBy | null
  limits: { nobody: HolderLimit; user: HolderLimit | null; any_user: HolderLimit | null }
  stable_intervals: [number, number | null][] | null
  crossovers: Crossover[] | null
  modes: { frequency_hz: number; damping_ratio: number }[]
  any_user: {
    critical_stiffness: number | null
    frequency_rad_s: number | null
    critical_stiffness_interval?: [number, number | null] | null
  } | null
  rigid_approximation: { mass: number } | null
  wall: (Margins & { stiffness: number; damping: number; stable_for: StableFor }) | null
  force_per_count: { largest: number | null } | null
  critical_stiffness_interval: [number, number] | null
  assumed: string[]
}
export interface Curve {
  frequency_rad_s: number[]
  magnitude_db: (number | null)[]
  phase_deg: (number | null)[]
}
export interface Bode {
  device: string
  nyquist_rad_s: number
  sampled: Curve
  continuous: Curve
  crossovers: Crossover[] | null
  trust: Trust
  remarks: Remark[]
  findings: Finding[]
}
export interface WallPoint {
  stiffness: number
  damping: number
  frequency_rad_s?: number | null
  limited_by?: LimitedBy | null
}
export interface Region extends Judged {
  status: string
  critical_stiffness: number | null
  stiffest: WallPoint | null
  most_damped: WallPoint | null
  components: { area: number; outline: { boundary: string; points: WallPoint[] }[] }[]
  /** With nobody holding, where the file has a user: the rest is with that one. */
  nobody?: Pick<Region, 'stiffest' | 'most_damped' | 'components'> | null
  any_user: { stiffest: WallPoint | null; most_damped: WallPoint | null; limits: WallPoint[][] } | null
}
export interface Sensitivity {
  parameter: string
  value: number
  unit: string
  slope: number | null
  relative: number | null
  any_user_slope: number | null
  any_user_relative: number | null
}
export interface Design extends Judged {
  status: string
  critical_stiffness: number | null
  limited_by: LimitedBy | null
  any_user_stiffness: number | null
  sensitivities: Sensitivity[]
  /** null: not searched, above 8 bodies. */
  branch_switches:
    | {
        parameter: string
        value: number
        critical_stiffness: number
        critical_stiffness_beyond: number | null
        limited_by: LimitedBy
        limited_by_beyond: LimitedBy | null
        frequency_rad_s: number
        frequency_beyond_rad_s: number | null
      }[]
    | null
}
export interface Sweep {
  axes: { parameter: string; unit: string; values: number[] }[]
  points: { status: string; critical_stiffness: number | null; limited_by: LimitedBy | null; any_user_stiffness: number | null }[]
  units: { stiffness: string }
  trust?: Trust
  remarks?: Remark[]
  findings?: Finding[]
}
/** What a proposal does to the limit with any passive user; null: no limit, or not known where `safe` is null too. */
export interface ForAnyUser {
  any_user_then: number | null
  safe: boolean | null // it does not lower that limit
}
export interface Target extends Judged {
  target: number | null
  stiffness_now: number | null
  damping_now: number | null
  any_user_now: number | null
  targets: ({ parameter: string; value_now: number; value_needed: number | null; why: string } & ForAnyUser)[]
}
export interface WallToRender {
  stiffness: number
  damping: number
  velocity_filter_hz: number
  filters: ({ type: string } & Record<string, unknown>)[] // those of the file, then the new notch
  has_new_notch: boolean
}
export interface Option {
  what: string
  wall: WallToRender | null
  bounded_by: Record<string, string | null>
  margins: (Margins & { any_user_critical_stiffness: number | null; contact_damping_ratio?: number | null }) | null
  force_per_count: { largest: number | null } | null
}
export interface Recommendation extends Judged, Omit<Option, 'what'> {
  status: string
  asked: { gain_margin_db: number; phase_margin_rad: number }
  reason: string | null
  alternatives: Option[]
}
export interface Diagnosis extends Judged {
  cause: string | null
  nearest: string | null // the cause, or else what would be it with the least otherwise; what the changes move
  limit_of: string // 'damping' of a damper alone, K = 0
  any_user_now: number | null
  oscillates_hz: number
  stiffness: number | null
  damping: number
  candidates: {
    cause: string
    fits: boolean
    frequency_hz: number | null
    stiffness: number | null
    why: string
    otherwise: { limit: number; frequency: number; amplitude: number } | null // factors; null: it fits, or no factor helps
  }[]
  changes: ({
    what: string
    parameter: string
    value_now: number
    value_then: number
    limit_now: number | null
    limit_then: number | null
    ends_it: boolean | null
  } & ForAnyUser)[]
}
export interface Simulation {
  device: string
  units: { length: string; force: string; stiffness: string; damping: string; energy: string }
  sampling_period_s: number
  duration_s: number
  verdict: string
  oscillation: { frequency_hz: number; amplitude: number } | null
  growth_rate_per_s: number | null
  settling_time_s: number | null
  peak_penetration: number | null
  generated_energy: number | null
  force_ripple: { amplitude: number; frequency_hz: number } | null
  encoder_chatters: boolean
  nonlinear_parts: string[]
  linear: { wall_share: number | null; wall_stable: boolean | null; agrees: boolean | null }
  trust: Trust
  remarks: Remark[]
  findings: Finding[]
  points?: {
    time_s: number[]
    measured: number[]
    command: number[]
    user_force: number[]
    bodies: { body: string; position: number[]; velocity: number[] }[]
  }
}
export interface Relay {
  device: string
  units: { stiffness: string; force: string; length: string }
  mean: { frequency_hz: number; stiffness: number; stiffness_db: number; amplitude: number } | null
  predictions: { critical: Crossover | null; crossovers: Crossover[] } | null
  explanation: string[]
  limit_reading: string | null
  trust: Trust
  remarks: Remark[]
  findings: Finding[]
}
export interface Recording {
  id: string
  format: string
  columns: { name: string; samples: number; detail: string }[]
  remarks: Remark[]
  findings: Finding[]
}
export interface FrequencyResponse {
  status: string
  units: { force: string; position: string; stiffness: string }
  critical_stiffness: number | null
  critical_stiffness_interval: [number, number] | null
  critical_frequency_hz: number | null
  measured_band_hz: [number, number] | null
  frequency_hz: number[]
  magnitude: (number | null)[]
  magnitude_lower: (number | null)[]
  magnitude_upper: (number | null)[]
  phase_rad: (number | null)[]
  coherence: (number | null)[] | null
  trust: Trust
  remarks: Remark[]
  findings: Finding[]
}
export interface Identification extends Omit<Judged, 'units'> {
  /** Without: of inverse dynamics, which state no limit. */
  units?: Judged['units']
  relative_residual?: number
  parameters: { key: string; value: number; unit: string; interval: [number, number] | null; identifiable: boolean }[]
  misfit: number | null
  status: string
  critical_stiffness: number | null
  critical_stiffness_interval: [number, number] | null
  critical_frequency_hz: number | null
  points?: { frequency_hz: number[]; measured: [number, number][]; fitted: [number, number][] }
  device_toml: string
}
export interface Example {
  file: string
  name: string
  opened: boolean
  device_toml: string
}
