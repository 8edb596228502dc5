import { readFileSync, readdirSync } from 'node:fs'
import { describe, expect, it } from 'vitest'
import { decode, encode, longestAddress } from '../../src/model/address'
import { History } from '../../src/model/history'
import { empty, type Snapshot } from '../../src/model/snapshot'
import { find, scan, set, withoutComments } from '../../src/model/toml'

const devices = new URL('../../../devices/', import.meta.url)
const examples = readdirSync(devices)
  .filter((name) => name.endsWith('.toml'))
  .map((name) => readFileSync(new URL(name, devices), 'utf8'))
const lhifam = readFileSync(new URL('lhifam.toml', devices), 'utf8')

const stateOf = (text: string): Snapshot | null => {
  const decoded = decode(text)
  return 'state' in decoded ? decoded.state : null
}
const problemOf = (text: string): string => {
  const decoded = decode(text)
  return 'problem' in decoded ? decoded.problem : ''
}

describe('address', () => {
  it('returns every example bit for bit', () => {
    for (const toml of examples) {
      const state = { ...empty(toml), locks: ['body.motor.mass'], settings: { relayAmplitude: '5', targetAnyUser: true } }
      const address = encode(state)!
      expect(address.left).toBe('nothing')
      expect(address.text).toMatch(/^[\w-]+$/)
      expect(address.text.length).toBeLessThanOrEqual(longestAddress)
      expect(stateOf(address.text)).toEqual(state)
    }
  })

  it('returns every double bit for bit', () => {
    let seed = 7
    for (let i = 0; i < 500; ++i) {
      seed = (seed * 48271) % 2147483647
      const value = (seed / 2147483647) * 10 ** ((seed % 60) - 30)
      const toml = set(lhifam, ['link', '0', 'stiffness'], String(value))
      const back = stateOf(encode(empty(toml))!.text)!
      expect(back.toml).toBe(toml)
      expect(find(scan(back.toml), ['link', '0', 'stiffness'])?.value).toBe(value)
    }
  })

  it('keeps pins of the same device for little', () => {
    const toml = lhifam
    const pins = [1, 2, 3, 4].map((i) => ({ name: `try ${i}`, toml: set(toml, ['body', '0', 'mass'], String(i / 7)) }))
    const address = encode({ ...empty(toml), pins })!
    expect(address.left).toBe('nothing')
    expect(stateOf(address.text)?.pins).toEqual(pins)
  })

  it('leaves out comments first, then pins, then says no', () => {
    let seed = 3
    const noise = (length: number): string =>
      Array.from({ length }, () => String.fromCharCode(33 + ((seed = (seed * 48271) % 2147483647) % 90)))
        .join('')
        .replaceAll('\\', '/')
        .replaceAll('"', "'")
    const long = `${lhifam}# ${noise(3000)}\n`
    const address = encode(empty(long))!
    expect(address.left).toBe('comments')
    expect(stateOf(address.text)?.toml).toBe(withoutComments(long))
    expect(encode({ ...empty(lhifam), pins: [{ name: noise(3000), toml: '' }] })?.left).toBe('pins')
    expect(encode(empty(`name = "${noise(3000)}"`))).toBeNull()
  })

  it('refuses what is not its own, and says why', () => {
    for (const text of ['', '%', 'b', 'bAAAA', 'bAAAAAAAA', 'b%%%', 'b'.repeat(3000), 'b' + btoa('{}')])
      expect(problemOf(text), text).toMatch(/changed or cut off/)
    expect(problemOf('aXXXX')).toMatch(/older version/)
    expect(problemOf('cXXXX')).toMatch(/newer version/)
  })

  it('refuses a changed, lost or swapped character at every place', () => {
    const { text } = encode({ ...empty(lhifam), settings: { target: '12 kN/m' } })!
    const letters = 'ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_'
    const taken: string[] = []
    const refuse = (changed: string): void => void (changed !== text && problemOf(changed) === '' && taken.push(changed))
    for (let i = 1; i < text.length; ++i) {
      for (let k = i % 8; k < letters.length; k += 8) refuse(text.slice(0, i) + letters[k] + text.slice(i + 1))
      refuse(text.slice(0, i) + text.slice(i + 1))
      refuse(text.slice(0, i))
      refuse(text.slice(0, i) + (text[i + 1] ?? '') + text[i] + text.slice(i + 2))
    }
    expect(taken).toEqual([])
    for (const other of ['+', '/', '=', ' ', '\n']) expect(problemOf(text + other)).not.toBe('')
  })
})

describe('history', () => {
  it('takes back at least 100 steps, one by one', () => {
    const history = new History(0)
    for (let i = 1; i <= 150; ++i) history.change(i)
    for (let i = 149; i >= 0; --i) {
      history.undo()
      expect(history.current).toBe(i)
    }
    expect(history.canUndo).toBe(false)
    for (let i = 1; i <= 150; ++i) history.redo()
    expect(history.current).toBe(150)
    expect(history.canRedo).toBe(false)
  })

  it('makes a drag one step', () => {
    const history = new History(0)
    for (let i = 1; i <= 50; ++i) history.change(i, 'drag 1')
    for (let i = 51; i <= 90; ++i) history.change(i, 'drag 2')
    history.endGesture()
    history.change(91, 'drag 2')
    history.undo()
    expect(history.current).toBe(90)
    history.undo()
    expect(history.current).toBe(50)
    history.undo()
    expect(history.current).toBe(0)
  })

  it('forgets what was undone when something new is done', () => {
    const history = new History('a')
    history.change('b')
    history.undo()
    history.change('c')
    expect(history.canRedo).toBe(false)
  })
})
