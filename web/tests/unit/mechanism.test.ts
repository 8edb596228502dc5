import { readFileSync, readdirSync } from 'node:fs'
import { describe, expect, it } from 'vitest'
import type { Workspace, WorkspacePose } from '../../src/api/documents'
import { decode, encode } from '../../src/model/address'
import { setsFrom } from '../../src/model/commands'
import { deviceKey, groupsOf, shapeOf, type Joint } from '../../src/model/keys'
import {
  deviceOfMechanism,
  fileOf,
  likelyTip,
  tipsOf,
  tomlOfNormal,
  withMechanismText,
  withNormal,
  withPose,
} from '../../src/model/mechanism'
import { empty } from '../../src/model/snapshot'
import { find, scan, set, tomlOfLines, withoutComments } from '../../src/model/toml'
import { curveOf, gridOf, poseText, positionsOf, spotsOf, widestView } from '../../src/model/workspace'

const folder = new URL('../../../devices/mechanisms/', import.meta.url)
const read = (name: string): string => readFileSync(new URL(name, folder), 'utf8')
const armFile = read('planar_arm.xml')
const named = read('planar_arm.toml')
const arm = withMechanismText(named, armFile)
const value = (toml: string, ...path: string[]): unknown => find(scan(toml), path)?.value

describe('a mechanism in a device file', () => {
  it('takes the place of the file that was named, and nothing else changes', () => {
    expect(fileOf(named)).toBe('planar_arm.xml')
    expect(fileOf(arm)).toBe('')
    expect(value(arm, 'mechanism', 'text')).toBe(armFile)
    for (const { path, value: its } of scan(named).entries) {
      if (path.join('.') !== 'mechanism.file') expect(value(arm, ...path), path.join('.')).toEqual(its)
    }
    expect(value(withMechanismText(arm, '<mujoco/>'), 'mechanism', 'text')).toBe('<mujoco/>')
  })

  it('is any text, bit for bit', () => {
    for (const text of [
      armFile,
      'a',
      "it's '''quoted'''",
      "ends with '",
      'back\\slash \\n "quotes" """\nsecond\u0001\u007f',
      '\n\nempty lines\n\n',
      '# no comment',
      'é 😀',
    ])
      expect(value(`text = ${tomlOfLines(text)}\nnext = 1\n`, 'text'), text).toBe(text)
    expect(scan(`a = ${tomlOfLines('x"')}\nb = 2`).entries).toHaveLength(2)
    expect(value('a = """one \\\n   two \\u00e9 \\"""""\nb = 1', 'a')).toBe('one two é ""')
    expect(value("a = '''\nit''''\nb = 1", 'a')).toBe("it'")
  })

  it('keeps its lines where comments go', () => {
    const text = '<a>\n\n  <!-- # one -->   \n</a>\n'
    const toml = `# head\n[mechanism] # of it\ntext = ${tomlOfLines(text)}   # behind\n\n\ntip = "t"\n`
    const bare = withoutComments(toml)
    expect(bare).not.toContain('head')
    expect(bare).not.toContain('behind')
    expect(scan(bare).entries.map(({ path, value: its }) => [path, its])).toEqual(
      scan(toml).entries.map(({ path, value: its }) => [path, its]),
    )
  })

  it('names its tips', () => {
    expect(tipsOf(armFile)).toEqual(['tip', 'upper', 'fore', 'rotor 1', 'rotor 2'])
    expect(likelyTip(armFile)).toBe('tip')
    const robot = `<robot name="r"><link name='base'/><link name="hand"/><joint name="j"/></robot>`
    expect(tipsOf(robot)).toEqual(['base', 'hand'])
    expect(likelyTip(robot)).toBe('hand')
    expect(likelyTip('<mujoco/>')).toBeUndefined()
  })

  it('is a device to begin with, whose period is assumed', () => {
    const toml = deviceOfMechanism('arm "one"', armFile)
    expect(scan(toml).complete).toBe(true)
    expect(value(toml, 'name')).toBe('arm "one"')
    expect(value(toml, 'mechanism', 'tip')).toBe('tip')
    expect(value(toml, 'mechanism', 'normal')).toBe('all')
    expect(value(toml, 'uncertainty', 'assumed')).toEqual(['loop.sampling_period'])
  })

  it('goes to a pose and turns its wall, whatever its joints are called', () => {
    const turned = withNormal(arm, tomlOfNormal([0.5, -0.866025, 0]))
    expect(value(turned, 'mechanism', 'normal')).toEqual([0.5, -0.866, 0])
    const moved = withPose(arm, { shoulder: 0.12345678, 'motor 1': -2 })
    expect(value(moved, 'mechanism', 'pose', 'shoulder')).toBe(0.123457)
    expect(value(moved, 'mechanism', 'pose', 'motor 1')).toBe(-2)
    expect(value(moved, 'mechanism', 'pose', 'elbow')).toBe('68.75 deg')
    const tables = set(set('[mechanism]\ntip = "t"\n', ['mechanism', 'pose', 'a b'], '1'), ['mechanism', 'pose', 'c'], '2')
    expect(value(tables, 'mechanism', 'pose', 'a b')).toBe(1)
    expect(value(tables, 'mechanism', 'pose', 'c')).toBe(2)
    expect(scan(tables).complete).toBe(true)
  })

  it('is the same device at another pose, another one with another file', () => {
    expect(deviceKey(withPose(arm, { shoulder: 1 }))).toBe(deviceKey(arm))
    expect(deviceKey(withNormal(arm, '"all"'))).toBe(deviceKey(arm))
    expect(deviceKey(withMechanismText(arm, `${armFile} `))).not.toBe(deviceKey(arm))
  })

  it('fits a link', () => {
    const address = encode(empty(arm))!
    const decoded = decode(address.text)
    const toml = 'state' in decoded ? decoded.state.toml : ''
    expect(value(toml, 'mechanism', 'text')).toBe(armFile)
  })

  it('is said by --set where a pose or a normal differs', () => {
    const other = withNormal(withPose(arm, { shoulder: 0.5, 'motor 1': 0 }), '[0, 1, 0]')
    expect(setsFrom(arm, other)).toEqual(['mechanism.pose.shoulder=0.5', 'mechanism.pose.motor 1=0', 'mechanism.normal=[0, 1, 0]'])
    expect(setsFrom(arm, withNormal(arm, '"all"'))).toEqual(['mechanism.normal=all'])
    expect(setsFrom(arm, withMechanismText(arm, '<mujoco/>'))).toBeNull()
  })

  it('has rows for its joints and the motors behind them', () => {
    const joints: Joint[] = [
      { name: 'shoulder', unit: 'rad', position: 0.3, range: [-1, 2] },
      { name: 'slide', unit: 'm', position: 0.02, range: null },
    ]
    const [pose, ...others] = groupsOf(scan(arm), [], joints)
    expect(pose!.rows.map(({ key, unit, value: its }) => [key, unit, its])).toEqual([
      ['mechanism.pose.shoulder', 'rad', 0.3],
      ['mechanism.pose.slide', 'm', undefined],
      ['mechanism.pose.elbow', 'rad', '68.75 deg'],
    ])
    expect(pose!.rows[0]!.field.travel).toEqual({ from: -1, to: 2, at: 0.3 })
    const slide = pose!.rows[1]!.field.travel!
    expect(slide.from).toBeLessThan(0.02)
    expect(slide.to).toBeGreaterThan(0.02)
    expect(others.some(({ id }) => id.startsWith('body.'))).toBe(false)
    const phantom = groupsOf(scan(read('phantom_premium.toml')))
    expect(phantom.filter(({ id }) => id.startsWith('transmission.'))).toHaveLength(3)
    expect(groupsOf(scan(arm), [pose!], joints)[0]).toBe(pose)
  })

  it('finds every number of every mechanism that comes with the program', () => {
    for (const file of readdirSync(folder).filter((name) => name.endsWith('.toml'))) {
      const scanned = scan(read(file))
      expect(scanned.complete, file).toBe(true)
      expect(shapeOf(scanned).mechanism?.tip, file).not.toBe('')
    }
  })
})

const limit = (least: number | null, normal = [1, 0, 0]) => ({ value: least, normal, frequency_hz: 5 })
const pose = (tip: number[] | null, least: number | null, anyUser: number | null): WorkspacePose => ({
  pose: [0.5, 0.02],
  tip,
  problem: null,
  least: limit(least),
  greatest: limit(least),
  least_any_user: limit(anyUser),
})
const workspace = (poses: WorkspacePose[], isKnown = true): Workspace => {
  const least = { ...limit(100), pose: [0.5, 0.02], tip: [0, 0, 0], limited_by: null }
  return {
    joints: [
      { name: 'elbow', unit: 'rad' },
      { name: 'slide', unit: 'm' },
    ],
    least,
    least_any_user: isKnown ? least : null,
    poses,
  } as unknown as Workspace
}

describe('a workspace', () => {
  it('draws the least last, and no pose without a limit', () => {
    const none = { ...pose([1, 1, 0], 5, 5), least: null, least_any_user: null }
    const of = workspace([pose([0, 0, 0], 300, 250), pose([1, 0, 0], null, null), none, pose(null, 10, 10), pose([0, 1, 0], 200, 220)])
    expect(spotsOf(of).map(({ index, limit: its }) => [index, its])).toEqual([
      [1, null],
      [0, 250],
      [4, 220],
    ])
    expect(spotsOf({ ...of, least_any_user: null }).map(({ index }) => index)).toEqual([1, 0, 4])
  })

  it('looks at the plane in which the tip moves', () => {
    expect(
      widestView([
        [0, 0, 0],
        [1, 2, 0],
      ]),
    ).toEqual([0, 1])
    expect(
      widestView([
        [0, 0, 0],
        [1, 0, 2],
      ]),
    ).toEqual([0, 2])
    expect(
      widestView([
        [0, 0, 0],
        [0, 1, 2],
      ]),
    ).toEqual([1, 2])
  })

  it('says a pose, and takes it back to the file', () => {
    const of = workspace([])
    expect(poseText(of, [Math.PI / 2, -0.02])).toBe('elbow 90°, slide −20 mm')
    expect(positionsOf(of, [0.5, null])).toEqual({ elbow: 0.5 })
  })

  it('draws the limit around a tip both ways, as shares of the greatest', () => {
    const directions = [0, 1, 2, 3].map((i) => ({
      normal: [Math.cos((i * Math.PI) / 4), Math.sin((i * Math.PI) / 4), 0],
      status: i === 2 ? 'unbounded' : 'finite',
      nobody: i === 2 ? null : 100 * (i + 1),
      any_user: i === 2 ? null : 50 * (i + 1),
    }))
    const curve = curveOf({ ...pose([0, 0, 0], 1, 1), directions }, false, [0, 1])
    expect(curve).toHaveLength(8)
    expect(Math.hypot(...curve[0]!)).toBeCloseTo(0.25)
    expect(Math.hypot(...curve[2]!)).toBeCloseTo(1)
    for (let i = 0; i < 4; ++i) expect(curve[i + 4]!.map((each) => -each)).toEqual(curve[i])
    expect(curveOf({ ...pose([0, 0, 0], 1, 1), directions: directions.slice(0, 2) }, false, [0, 1])).toEqual([])
  })

  it('asks a grid over the ranges, and none where a joint has none', () => {
    const joint: Joint = { name: 'a', unit: 'rad', position: 0, range: [-1, 2] }
    expect(gridOf([joint, { ...joint, name: 'b' }])).toBe('a=-1:2:15,b=-1:2:15')
    expect(gridOf([joint, { ...joint, range: null }])).toBeNull()
    expect(gridOf([])).toBeNull()
  })
})
