// The recording that the tab works on: how it is read, what was done when it was made, and what is fitted.
import { Answer } from '../api/answer.svelte'
import { messageIn, upload } from '../api/client'
import type { FrequencyResponse, Identification, Recording } from '../api/documents'
import { written } from '../model/decimal'
import { fitLine, type Cut } from '../model/commands'
import { cutText, rawTable, type RawTable } from '../model/raw_table'
import { workbench } from '../model/workbench.svelte'

/** What is stated where it is not found. All texts, as typed or chosen. */
const unstated = {
  force: '',
  position: '',
  time: '',
  rate: '',
  forceScale: '',
  positionScale: '',
  segment: '',
  delimiter: '',
  decimal: '',
  header: '',
  skipped: '',
}

class Recorded {
  file = $state('')
  /** As the program has it: the whole file, or what was cut of it. */
  recording = $state.raw<Recording | null>(null)
  private whole: Recording | null = null
  text = $state.raw('') // of a text
  cut = $state.raw<Cut | null>(null)
  trouble = $state('')
  busy = $state('')
  stated = $state({ ...unstated })
  structure = $state('two-body')
  method = $state('time-domain')
  motion = $state('linear')
  still = $state<string[]>([])
  started = $state(false)
  /** The device shown when Fit was pressed: what is done with it since, "use" too, asks for no other fit. */
  private begun = $state.raw<{ toml: string; free: string[] }>({ toml: '', free: [] })

  readonly listing = new Answer<Omit<Recording, 'id'>>()
  readonly response = new Answer<FrequencyResponse>(true)
  readonly fit = new Answer<Identification>(true)

  async take(given: File | undefined): Promise<void> {
    if (!given) return
    this.file = given.name
    this.trouble = ''
    this.started = false
    this.recording = this.whole = this.cut = null
    this.text = ''
    // Of the file before: a unit that stays would scale this one, too.
    this.stated = { ...unstated }
    this.still = []
    const found = (this.whole = await this.send(given, 'sending the file …'))
    if (!found) return
    if (/^(text|csv)?$/.test(found.format)) this.text = await given.text()
    if (found.columns.some((each) => /torque|angle|theta|n_m|rad/i.test(each.name))) this.motion = 'rotary'
  }
  private async send(content: Blob, told: string): Promise<Recording | null> {
    this.busy = told
    let found: Recording | null = null
    try {
      found = this.recording = await upload<Recording>('recordings', content)
    } catch (error) {
      this.trouble = `${this.file}: ${messageIn(error)}`
    }
    this.busy = ''
    return found
  }
  /** Goes on with the rows from one to another of those drawn. */
  async keep(from: number, to: number): Promise<void> {
    const [table, first] = [this.raw, this.layout?.firstRow]
    if (!table || first === undefined) return
    const lines = { above: first - 1, from: table.lines[from]!, to: table.lines[to]! }
    if (!(await this.send(new Blob([cutText(this.text, first, lines.from, lines.to)]), 'cutting …'))) return
    this.cut = lines
    this.started = false
  }
  keepAll(): void {
    this.recording = this.whole
    this.cut = null
    this.started = false
  }
  begin(): void {
    this.begun = { toml: workbench.toml, free: this.free }
    this.started = true
  }

  more = $derived(
    this.recording ? { recording: { id: this.recording.id, name: /^[^-/][^/]*$/.test(this.file) ? this.file : 'recording' } } : {},
  )
  // What is stated of a text; else it is found. Then the program lists its columns anew.
  reading = $derived({
    ...(this.stated.delimiter ? { delimiter: this.stated.delimiter } : {}),
    ...(this.stated.decimal ? { decimal: this.stated.decimal } : {}),
    ...(this.stated.header ? { [this.stated.header]: true } : {}),
    ...(this.stated.skipped.trim() ? { 'skip-rows': this.stated.skipped.trim() } : {}),
  })
  isReadAsStated = $derived(Object.keys(this.reading).length > 0)
  listed = $derived(this.recording === null ? null : this.isReadAsStated ? this.listing.document : this.recording)
  names = $derived(this.listed?.columns.map((each) => each.name) ?? [])

  private layout = $derived.by(() => {
    // A cut begins where the whole does.
    const found = this.listed?.findings.find((each) => each.code === 'text_table')?.evidence
    const [firstRow, columns] = [found?.['first_row'], found?.['columns']]
    return typeof firstRow === 'number' && typeof columns === 'number'
      ? { firstRow, columns, delimiter: this.stated.delimiter, decimal: this.stated.decimal }
      : null
  })
  /** The rows of the whole file, as they stand there. */
  raw: RawTable | null = $derived(this.text && this.layout ? rawTable(this.text, this.layout) : null)

  isRigidBody = $derived(this.method === 'inverse-dynamics') // it knows no other structure
  isOfDevice = $derived(this.structure === 'device' && !this.isRigidBody)
  rotary = $derived(this.isOfDevice ? workbench.rotary : this.motion === 'rotary')
  // Of the device shown what is locked keeps its value.
  private free = $derived(
    workbench.state.locks.length === 0
      ? []
      : workbench.groups.flatMap((group) =>
          group.rows
            .filter(
              (row) =>
                (/^body\..*\.(mass|damping)$|^link\.\d+\.(stiffness|damping)$/.test(row.key) ||
                  ((written(row.value)?.number ?? 0) !== 0 &&
                    /^body\..*\.stiffness$|^loop\.delay$|^actuator\.time_constant$/.test(row.key))) &&
                !workbench.isLocked(row.key),
            )
            .map((row) => row.key),
        ),
  )
  /** Those of the structure, as the program names them. */
  bodies = $derived(
    this.isRigidBody
      ? []
      : this.isOfDevice
        ? workbench.shape.bodies
        : ({ 'two-body': ['motor', 'handle'], 'three-body': ['motor', 'body', 'handle'] }[this.structure] ?? []),
  )
  locked = $derived(this.still.filter((each) => this.bodies.includes(each)))

  columns = $derived({
    ...this.reading,
    force: this.stated.force,
    position: this.stated.position,
    ...(this.stated.rate ? { rate: this.stated.rate } : {}),
    ...(this.stated.time ? { time: this.stated.time } : {}),
    ...(this.stated.forceScale.trim() ? { 'force-scale': this.stated.forceScale.trim() } : {}),
    ...(this.stated.positionScale.trim() ? { 'position-scale': this.stated.positionScale.trim() } : {}),
  })
  private estimate = $derived(this.stated.segment.trim() ? { segment: this.stated.segment.trim() } : {})
  private asked = $derived({
    ...this.columns,
    ...(this.isRigidBody ? {} : this.estimate), // of a rigid body the fit has no points of a response
    ...(this.method === 'time-domain' ? {} : { method: this.method }), // the program's choice for a force and a position
    ...(this.locked.length > 0 ? { locked: this.locked } : {}),
    ...(this.isOfDevice
      ? this.begun.free.length > 0
        ? { free: this.begun.free }
        : {}
      : { ...(this.isRigidBody ? {} : { structure: this.structure }), motion: this.motion }),
  })
  private ready = $derived(this.started && this.listed !== null && this.stated.force !== '' && this.stated.position !== '')

  /** Called while a component is set up. */
  ask(): void {
    $effect(() =>
      this.listing.ask(
        this.recording && this.isReadAsStated ? { path: 'frf', options: { list: true, ...this.reading }, more: this.more } : null,
      ),
    )
    $effect(() =>
      this.response.ask(
        this.ready
          ? {
              path: 'frf',
              options: {
                ...this.columns,
                ...this.estimate,
                points: true,
                ...(this.rotary ? { 'force-unit': 'N m', 'position-unit': 'rad' } : {}),
              },
              more: this.more,
            }
          : null,
      ),
    )
    $effect(() =>
      this.fit.ask(
        this.ready
          ? {
              path: 'identify',
              ...(this.isOfDevice ? { toml: this.begun.toml } : {}),
              options: { ...this.asked, ...(this.isRigidBody ? {} : { points: true }) },
              more: this.more,
            }
          : null,
      ),
    )
  }
  /** The fit as it was asked last, in the recording's folder. */
  command(): string {
    return fitLine(this.file, this.asked, this.isOfDevice ? this.begun.toml : null, this.cut)
  }
}
export const recorded = new Recorded()
