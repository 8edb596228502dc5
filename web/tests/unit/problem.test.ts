import { describe, expect, it } from 'vitest'
import { Problem } from '../../src/api/client'

describe('problem', () => {
  it('says the whole place', () => {
    const what = 'has 1 cell'
    expect(new Problem('recording:4:1', what, 'must have 3 cells', 400).message).toBe(
      'Line 4, column 1 of the recording: has 1 cell: must have 3 cells',
    )
    expect(new Problem('recording:4', what, '', 400).message).toBe('Line 4 of the recording: has 1 cell')
    expect(new Problem('recording', what, '', 400, { line: 4, column: 1 }).message).toBe('Line 4, column 1 of the recording: has 1 cell')
    expect(new Problem('recording, column "force"', what, '', 400).message).toBe('recording, column "force": has 1 cell')
    expect(new Problem('recording', what, '', 400).message).toBe('recording: has 1 cell')
    expect(new Problem('device:3:7', what, '', 400).message).toBe('Line 3, column 7 of the device file: has 1 cell')
    expect(new Problem('device.body.a.mass', what, '', 400).message).toBe('device.body.a.mass: has 1 cell')
    expect(new Problem('device.body.a.mass', what, '', 400, { line: 2, column: 5 }).message).toBe(
      'Line 2, column 5 of the device file: device.body.a.mass: has 1 cell',
    )
  })

  it('has a line to show in the device file only', () => {
    expect(new Problem('device:3:7', '', '', 400).line).toBe(3)
    expect(new Problem('device.body.a.mass', '', '', 400, { line: 2 }).line).toBe(2)
    expect(new Problem('device.body.a.mass', '', '', 400).line).toBeNull()
    expect(new Problem('recording:4:1', '', '', 400).line).toBeNull()
  })
})
