import { readFileSync, readdirSync } from 'node:fs'
import { describe, expect, it } from 'vitest'
import { setsFrom } from '../../src/model/commands'
import { groupsOf, shapeOf } from '../../src/model/keys'
import {
  addBody,
  assumedKeys,
  choose,
  confirm,
  connect,
  freeName,
  newDevice,
  newLinkedDevice,
  removeBody,
  removeDamper,
  removeLink,
} from '../../src/model/parts'
import { find, scan, set, unset, withoutComments } from '../../src/model/toml'

const devices = new URL('../../../devices/', import.meta.url)
const lhifam = readFileSync(new URL('lhifam.toml', devices), 'utf8')

describe('toml', () => {
  it('finds every number of every example', () => {
    for (const file of readdirSync(devices).filter((name) => name.endsWith('.toml'))) {
      const text = readFileSync(new URL(file, devices), 'utf8')
      const scanned = scan(text)
      expect(scanned.complete, file).toBe(true)
      for (const entry of scanned.entries) {
        if (typeof entry.value === 'number') expect(Number(text.slice(entry.start, entry.end).replaceAll('_', '')), file).toBe(entry.value)
      }
    }
  })

  it('replaces one value and leaves all else as it was', () => {
    const changed = set(lhifam, ['link', '0', 'stiffness'], '80e3')
    expect(changed).toBe(lhifam.replace('79.5e3', '80e3'))
    expect(set(changed, ['link', '0', 'stiffness'], '79.5e3')).toBe(lhifam)
  })

  it('adds a key to its table, and a table that is missing', () => {
    expect(find(scan(set(lhifam, ['loop', 'delay'], '1e-4')), ['loop', 'delay'])?.value).toBe(1e-4)
    expect(find(scan(set(lhifam, ['body', '0', 'coulomb'], '0.5')), ['body', '0', 'coulomb'])?.value).toBe(0.5)
    const walled = set(set(lhifam, ['wall', 'stiffness'], '5000'), ['wall', 'damping'], '5')
    expect(walled.endsWith('\n[wall]\nstiffness = 5000\ndamping = 5\n')).toBe(true)
  })

  it('takes a value out, and leaves all else as it was', () => {
    expect(unset(lhifam, ['link', '0', 'damping'])).toBe(lhifam.replace(/damping = 15\.0.*\n/, ''))
    expect(set(unset('a = 1\n[wall]\nstiffness = 5 # why\ndamping = 2\n', ['wall', 'stiffness']), ['a'], '2')).toBe(
      'a = 2\n[wall]\ndamping = 2\n',
    )
    for (const [text, path, left] of [
      ['wall = { stiffness = 5 , damping = 2 }', ['wall', 'stiffness'], 'wall = { damping = 2 }'],
      ['wall = { stiffness = 5 , damping = 2 }', ['wall', 'damping'], 'wall = { stiffness = 5 }'],
      ['wall = { stiffness = 5 }', ['wall', 'stiffness'], 'wall = { }'],
      ['wall.stiffness = 5\nwall.damping = 2', ['wall', 'damping'], 'wall.stiffness = 5\n'],
      ['x = [1,\n 2]\ny = 3\n', ['x'], 'y = 3\n'],
      ['y = 3\n', ['x'], 'y = 3\n'],
    ] as const) {
      expect(unset(text, [...path]).replace(/\s+\}/, ' }')).toBe(left)
    }
  })

  it('reads inline tables, dotted and quoted keys, arrays over lines, long texts', () => {
    const text =
      'loop.delay = 1e-3 # why\nwall = { stiffness = 5 , damping = 2 }\n"a b" = [1,\n 2, # two\n]\nnote = """x = 1\n"""\nlast = true'
    const scanned = scan(text)
    expect(scanned.complete).toBe(true)
    expect(scanned.entries.map((each) => [each.path.join('.'), each.value])).toEqual([
      ['loop.delay', 1e-3],
      ['wall.stiffness', 5],
      ['wall.damping', 2],
      ['a b', [1, 2]],
      ['note', 'x = 1\n'],
      ['last', true],
    ])
    expect(find(scan(set(text, ['wall', 'velocity_filter_hz'], '9')), ['wall', 'velocity_filter_hz'])?.value).toBe(9)
    expect(find(scan(set(text, ['loop', 'sampling_period'], '2')), ['loop', 'sampling_period'])?.value).toBe(2)
  })

  it('stops at what is no TOML and keeps what came before', () => {
    const scanned = scan('name = "x"\nmass = = 3\n')
    expect(scanned.complete).toBe(false)
    expect(scanned.entries).toHaveLength(1)
  })

  it('drops comments, not values', () => {
    const bare = withoutComments('# a\nx = "#no" # b\n\n\ny = 1\n')
    expect(bare).toBe('x = "#no"\ny = 1\n')
    expect(scan(withoutComments(lhifam)).entries.map((each) => each.value)).toEqual(scan(lhifam).entries.map((each) => each.value))
  })

  it('names rows as --set does', () => {
    const keys = groupsOf(scan(lhifam)).flatMap((group) => group.rows.map((row) => row.key))
    for (const key of ['body.motor.mass', 'body.handle.coulomb', 'link.0.stiffness', 'loop.delay', 'wall.stiffness', 'operator.mass']) {
      expect(keys).toContain(key)
    }
    const drive = scan(readFileSync(new URL('two_mass_drive.toml', devices), 'utf8'))
    const inertia = groupsOf(drive)[0]!.rows[0]!
    expect([inertia.key, inertia.path.at(-1), inertia.unit, inertia.value]).toEqual(['body.motor.mass', 'inertia', 'kg m²', 0.005])
    expect(shapeOf(drive)).toMatchObject({ bodies: ['motor', 'load'], links: [['motor', 'load']], actuated: 'motor', held: 'load' })
  })

  it('adds and removes bodies and links, and leaves the rest as it was', () => {
    const three = addBody(lhifam, 'finger "1"', 'handle')
    expect(shapeOf(scan(three))).toMatchObject({
      bodies: ['motor', 'handle', 'finger "1"'],
      links: [
        ['motor', 'handle'],
        ['handle', 'finger "1"'],
      ],
      actuated: 'motor',
      held: 'handle',
    })
    expect(removeBody(three, 'finger "1"').replace(/\n+/g, '\n')).toBe(lhifam.replace(/\n+/g, '\n'))
    const alone = removeBody(lhifam, 'handle')
    expect(shapeOf(scan(alone))).toMatchObject({ bodies: ['motor'], links: [], actuated: 'motor', sensed: 'motor', held: 'motor' })
    expect(alone).toContain('# LHIfAM, a large haptic interface')
    const other = connect(choose(three, 'sensed', 'handle'), 1, 'motor', 'finger "1"')
    expect(shapeOf(scan(other))).toMatchObject({
      links: [
        ['motor', 'handle'],
        ['motor', 'finger "1"'],
      ],
      sensed: 'handle',
    })
    expect(shapeOf(scan(removeLink(other, 0))).links).toEqual([['motor', 'finger "1"']])
    expect(freeName(three)).toBe('body 4')
  })
})

describe('assumed numbers', () => {
  it('are told until they are changed or said to be right', () => {
    const wheel = newLinkedDevice('rotary')
    expect(assumedKeys(wheel)).toEqual([
      'body.motor.mass',
      'body.motor.damping',
      'loop.sampling_period',
      'body.wheel.mass',
      'link.0.stiffness',
      'link.0.damping',
    ])
    expect(assumedKeys(withoutComments(wheel))).toEqual(assumedKeys(wheel))
    const one = confirm(wheel, 'body.wheel.mass')
    expect(assumedKeys(one)).toHaveLength(5)
    expect(assumedKeys(confirm(one, 'body.motor.inertia'))).toHaveLength(4)
    expect(confirm(one)).not.toContain('uncertainty')
    expect(confirm(one, 'wall.stiffness')).toBe(one)
  })
  it('are those of what is added to a device too, and go with what is removed', () => {
    const device = addBody(confirm(newDevice('linear')), 'handle', 'body 1')
    expect(assumedKeys(device)).toEqual(['body.handle.mass', 'link.0.stiffness', 'link.0.damping'])
    const three = addBody(device, 'knob', 'handle')
    expect(assumedKeys(removeLink(confirm(three, 'link.1.damping'), 0))).toEqual(['body.handle.mass', 'body.knob.mass', 'link.0.stiffness'])
    expect(assumedKeys(removeBody(three, 'handle'))).toEqual(['body.knob.mass'])
    expect(removeBody(removeBody(three, 'handle'), 'knob')).not.toContain('uncertainty')
  })
  it('go with the damper’s own loop, which comes and goes in any kind of table', () => {
    const damped = set(set(lhifam, ['loop', 'damper', 'sampling_period'], '1e-4'), ['loop', 'damper', 'delay'], '0')
    expect(damped).toContain('\n[loop.damper]\nsampling_period = 1e-4\ndelay = 0\n')
    expect(setsFrom(lhifam, damped)).toEqual(['loop.damper.sampling_period=1e-4', 'loop.damper.delay=0'])
    expect(removeDamper(damped)).toBe(lhifam)
    expect(removeDamper(lhifam)).toBe(lhifam)
    const assumed = `${damped}\n[uncertainty]\nassumed = ["loop.delay", "loop.damper.delay"]\n`
    expect(assumedKeys(removeDamper(assumed))).toEqual(['loop.delay'])
    const inline = 'loop = { sampling_period = 1e-3 }\n'
    const within = set(inline, ['loop', 'damper', 'delay'], '0')
    expect(within).toBe('loop = { sampling_period = 1e-3, damper.delay = 0 }\n')
    expect(removeDamper(within)).toBe(inline)
  })
  it('leave what else is said of the uncertainty', () => {
    const doubted = '[[body]]\nname = "a"\nmass = 1\n\n[uncertainty]\nwarning = "w" # why\nassumed = ["body.a.mass"]\n'
    expect(confirm(doubted)).toBe(doubted.replace('["body.a.mass"]', '[]'))
  })
})
