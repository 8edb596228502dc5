import { describe, expect, it } from 'vitest'
import { countsIn, unitIn } from '../../src/model/column_units'
import { fitLine } from '../../src/model/commands'
import { cutText, rawTable } from '../../src/model/raw_table'

describe('the rows of a recording', () => {
  const rows = [
    [0, 1.5, -2],
    [0.1, 2.5, 3e-4],
    [0.2, 0, 7],
  ]
  it.each([
    [',', '.'],
    [';', '.'],
    ['\t', '.'],
    ['  ', '.'],
    [';', ','],
    ['\t', ','],
  ])('are read with %j between the columns and %j in the numbers', (mark, point) => {
    const text = [
      '# made here',
      ['t', 'f', 'x'].join(mark),
      ...rows.map((row) => row.map((each) => String(each).replace('.', point)).join(mark)),
    ]
    text.splice(3, 0, '# a remark', '')
    const table = rawTable(text.join('\r\n'), { firstRow: 3, columns: 3 })!
    expect(table.rows).toBe(3)
    expect(table.lines).toEqual([3, 6, 7])
    for (const place of [0, 1, 2]) expect(table.column(place)).toEqual(rows.map((row) => row[place]))
  })

  it('are none where the page does not find the columns of the program', () => {
    expect(rawTable('1,2\n3,4\n', { firstRow: 1, columns: 3 })).toBeNull()
    expect(rawTable('1,2\n', { firstRow: 9, columns: 3 })).toBeNull()
    expect(rawTable('1,x\n', { firstRow: 1, columns: 2 })!.column(1)).toEqual([null])
  })

  it('of a long one every so manyth is drawn, and all are counted', () => {
    const table = rawTable('1\n'.repeat(120_000), { firstRow: 1, columns: 1 })!
    expect([table.rows, table.step]).toEqual([120_000, 3])
    expect(table.lines.length).toBe(40_000)
  })

  it('are cut with what stands above them', () => {
    expect(cutText('# a\nt,f\n1,2\n3,4\n5,6\n', 3, 4, 5)).toBe('# a\nt,f\n3,4\n5,6\n')
  })
})

describe('the unit in the name of a column', () => {
  it('is offered where it is not SI', () => {
    expect(['torque [mNm]', 'angle (deg)', 'x [µm]', 'force [N]', 'T (N·m)', 'x'].map(unitIn)).toEqual([
      '1 mN m',
      '1 deg',
      '1 um',
      '',
      '',
      '',
    ])
    expect(['angle [counts]', 'enc (ticks)', 'u [LSB]', 'force [N]', 'counts'].map(countsIn)).toEqual([true, true, true, false, false])
  })
})

describe('the command of a fit', () => {
  it('names the file, cuts it, and takes the device', () => {
    expect(fitLine('a b.csv', { force: 'f', locked: ['x', 'y'] }, null, null)).toBe(
      "zwidth identify 'a b.csv' --force f --locked x --locked y",
    )
    expect(fitLine('-r.csv', {}, null, { above: 1, from: 5, to: 9 })).toBe(
      "sed -n '1,1p;5,9p' ./-r.csv > ./-r_cut.csv && zwidth identify ./-r_cut.csv",
    )
    expect(fitLine('r', {}, null, { above: 0, from: 5, to: 9 })).toBe("sed -n '5,9p' r > r_cut && zwidth identify r_cut")
    expect(fitLine('r.csv', {}, 'name = "a"', null)).toBe(
      'zwidth identify r.csv --structure - <<\'END_OF_DEVICE\'\nname = "a"\nEND_OF_DEVICE',
    )
  })
})
