// The one state of the page. Panels read it; whatever changes it is a step that undo takes back.

import { decode, encode, type Decoded } from './address'
import { written } from './decimal'
import { History } from './history'
import { deviceKey, fullKey, groupsOf, isRotary, sameKey, shapeOf, type Group, type Joint, type Row } from './keys'
import { empty, type Settings, type Snapshot } from './snapshot'
import { confirm } from './parts'
import { scan, set, unset } from './toml'
import { holderName } from './words'

class Workbench {
  private history = new History<Snapshot>(empty(''))
  state = $state.raw<Snapshot>(empty(''))
  /** There is a device, if only an empty text. */
  hasBegun = $state(false)
  canUndo = $state(false)
  canRedo = $state(false)
  /** What the schematic or a panel points at: a group or a key. */
  selected = $state('')
  /** Of the address: what had to be left out. */
  note = $state('')
  /** The text as it was before the drag that is under way: for what nobody reads meanwhile. */
  restedToml = $state('')
  private restTimer: ReturnType<typeof setTimeout> | undefined
  private addressTimer: ReturnType<typeof setTimeout> | undefined
  /** As this page wrote it or followed it last; null: neither yet. */
  address: string | null = null

  toml = $derived(this.state.toml)
  settings: Settings = $derived(this.state.settings)
  pins = $derived(this.state.pins)
  scanned = $derived(scan(this.toml))
  private before: Group[] = []
  /** Of a mechanism, as the program's newest answer has them. */
  private learned = $state.raw<{ joints: Joint[]; of: string }>({ joints: [], of: '' })
  joints: Joint[] = $derived(this.learned.of === deviceKey(this.toml) ? this.learned.joints : [])
  groups: Group[] = $derived((this.before = groupsOf(this.scanned, this.before, this.joints)))
  private rows = $derived(new Map(this.groups.flatMap((group) => group.rows.map((row) => [row.key, row]))))
  shape = $derived(shapeOf(this.scanned))
  rotary = $derived(isRotary(this.scanned))
  /** Who holds the device where no other user is named: nobody, or the [operator] of the file. */
  holder = $derived(
    this.groups.some((group) => group.id === 'operator' && group.rows.some((row) => row.value !== undefined && row.value !== 0))
      ? holderName.user
      : holderName.nobody,
  )
  stiffnessUnit = $derived(this.rotary ? 'N m/rad' : 'N/m')
  dampingUnit = $derived(this.rotary ? 'N m s/rad' : 'N s/m')
  forceUnit = $derived(this.rotary ? 'N m' : 'N')
  lengthUnit = $derived(this.rotary ? 'rad' : 'm')

  /** Begins anew, without anything to undo. */
  begin(state: Snapshot): void {
    this.history = new History(state)
    this.show()
  }

  change(part: Partial<Snapshot>, gesture: string | null = null): void {
    this.history.change({ ...this.state, ...part }, gesture)
    this.show(gesture !== null)
  }
  endGesture(): void {
    this.history.endGesture()
    this.restedToml = this.state.toml
  }
  undo(): void {
    this.history.undo()
    this.show()
  }
  redo(): void {
    this.history.redo()
    this.show()
  }

  /** Another device: pins stay, so that it can be compared. */
  load(toml: string): void {
    this.change({ toml, locks: [] })
  }

  /** The whole state of a link, as one step. */
  follow(state: Snapshot): void {
    if (JSON.stringify(state) !== JSON.stringify(this.state)) this.change(state)
  }

  /** Where the joints of that device are. */
  learn(joints: Joint[], toml: string): void {
    this.learned = { joints, of: deviceKey(toml) }
  }

  row(key: string): Row | undefined {
    return this.rows.get(fullKey(key))
  }

  isLocked(key: string): boolean {
    return this.state.locks.some((each) => sameKey(each, key))
  }
  toggleLock(key: string): void {
    const locks = this.isLocked(key) ? this.state.locks.filter((each) => !sameKey(each, key)) : [...this.state.locks, key]
    this.change({ locks })
  }

  /** Values as TOML by key; locked ones stay. `more` comes behind the text, in the same step. */
  edit(values: Record<string, string>, gesture: string | null = null, more = ''): void {
    let toml = this.state.toml
    for (const [key, raw] of Object.entries(values)) {
      const row = this.row(key)
      if (row && !this.isLocked(key)) toml = confirm(set(toml, row.path, raw), row.key)
    }
    if (more) toml = `${toml.replace(/\n*$/, '\n')}\n${more}`
    if (toml !== this.state.toml) this.change({ toml }, gesture)
  }

  /** Takes a number that may be absent out of the file. */
  leaveOut(key: string): void {
    const row = this.row(key)
    if (row?.field.mayBeAbsent === undefined || this.isLocked(key)) return
    const toml = unset(confirm(this.state.toml, row.key), row.path)
    if (toml !== this.state.toml) this.change({ toml })
  }

  /** That number is right as it stands. */
  confirm(key: string): void {
    const toml = confirm(this.state.toml, key)
    if (toml !== this.state.toml) this.change({ toml })
  }

  /** The plain SI number of the file or what holds without it; null where it has a unit of its own or is none. */
  plain(key: string): number | null {
    const row = this.row(key)
    if (row?.value === undefined && row?.field.travel) return row.field.travel.at
    if (row?.value === undefined) return row?.field.like ? this.plain(row.field.like) : row?.field.mayBeZero ? 0 : null
    const value = written(row.value)
    return value?.unit === null ? value.number : null
  }

  setting<K extends keyof Settings>(key: K, value: Settings[K] | undefined): void {
    const settings = { ...this.state.settings }
    if (value === undefined || value === '') delete settings[key]
    else settings[key] = value
    this.change({ settings }, `setting ${key}`)
  }

  pin(name: string): void {
    this.change({ pins: [...this.state.pins, { name, toml: this.state.toml }] })
  }
  unpin(index: number): void {
    this.change({ pins: this.state.pins.filter((_, i) => i !== index) })
  }

  private show(inGesture = false): void {
    this.state = this.history.current
    this.hasBegun = true
    clearTimeout(this.restTimer)
    if (inGesture) this.restTimer = setTimeout(() => (this.restedToml = this.state.toml), 150)
    else this.restedToml = this.state.toml
    this.canUndo = this.history.canUndo
    this.canRedo = this.history.canRedo
    clearTimeout(this.addressTimer)
    this.addressTimer = setTimeout(() => {
      // Another address than the one known here is on its way: its hashchange comes next.
      if (this.address === null || this.address === location.hash) this.writeAddress()
    }, 250)
  }

  /** The link that shares all this. */
  writeAddress(): void {
    const address = encode(this.state)
    this.note =
      address === null
        ? 'This device is too long for a link; save it as a file.'
        : address.left === 'comments'
          ? 'The link leaves out the comments of the file.'
          : address.left === 'pins'
            ? 'The link leaves out the pinned designs.'
            : ''
    window.history.replaceState(null, '', address === null ? location.pathname : `#d=${address.text}`)
    this.address = location.hash
  }

  /** What the address holds; null: nothing. */
  static fromAddress(hash: string): Decoded | null {
    const text = new URLSearchParams(hash.replace(/^#/, '')).get('d')
    return text === null ? null : decode(text)
  }
}

export const workbench = new Workbench()
export const fromAddress = Workbench.fromAddress
