import { describe, expect, it } from 'vitest'
import { Problem, type Place, type Told } from '../../src/api/client'

const nowhere: Place = { file: null, line: null, column: null, key: null, option: null }
const told = (where: string, place: Partial<Place>, more: Partial<Told> = {}): Told => ({
  where,
  what: 'has 1 cell',
  allowed: '',
  suggestion: null,
  code: null,
  place: { ...nowhere, ...place },
  ...more,
})
const problem = (...all: Told[]): Problem => new Problem(all[0]!.where, all[0]!.what, all[0]!.allowed, 400, all)

describe('problem', () => {
  it('says the whole place', () => {
    const recording = { file: 'bench.csv', line: 4 }
    expect(problem(told('recording:4:1', { ...recording, column: 1 }, { allowed: 'must have 3 cells' })).message).toBe(
      'Line 4, column 1 of the recording: has 1 cell: must have 3 cells',
    )
    expect(problem(told('recording:4', recording)).message).toBe('Line 4 of the recording: has 1 cell')
    expect(problem(told('recording', { file: 'bench.csv' })).message).toBe('recording: has 1 cell')
    expect(problem(told('options.force', { option: 'force' })).message).toBe('options.force: has 1 cell')
    expect(problem(told('device:3:7', { file: 'device', line: 3, column: 7 })).message).toBe(
      'Line 3, column 7 of the device file: has 1 cell',
    )
    expect(problem(told('device.body.a.mass', { file: 'device', key: 'body.a.mass' })).message).toBe('device.body.a.mass: has 1 cell')
    expect(problem(told('device.body.a.mass', { file: 'device', line: 2, column: 5, key: 'body.a.mass' })).message).toBe(
      'Line 2, column 5 of the device file: device.body.a.mass: has 1 cell',
    )
    expect(new Problem('', 'the program does not answer', '', 0).message).toBe('the program does not answer')
  })

  it('has a line to show in the device file only', () => {
    expect(problem(told('device:3:7', { file: 'device', line: 3 })).line).toBe(3)
    expect(problem(told('device.body.a.mass', { file: 'device', key: 'body.a.mass' })).line).toBeNull()
    expect(problem(told('recording:4:1', { file: 'bench.csv', line: 4 })).line).toBeNull()
  })

  it('finds the problem of every key, with the value to take', () => {
    const both = problem(
      told('device.body.a.mass', { file: 'device', line: 3, key: 'body.a.mass' }),
      told('device.loop.delay', { file: 'device', line: 6, key: 'loop.delay' }, { suggestion: '0.5 ms' }),
    )
    expect(both.ofKey((key) => key === 'loop.delay')?.suggestion).toBe('0.5 ms')
    expect(both.ofKey((key) => key === 'body.a.mass')?.suggestion).toBeNull()
    expect(both.ofKey((key) => key === 'loop.held')).toBeUndefined()
    expect(both.message).toContain('And 1 more')
  })
})
