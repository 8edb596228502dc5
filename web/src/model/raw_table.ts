// The rows of a text as it stands, to be looked at and cut: the program says where its table is and how many columns it has.

export interface Layout {
  firstRow: number // line of the text, from 1
  columns: number
  delimiter?: string | undefined // as stated to the program: comma, semicolon, tab or space
  decimal?: string | undefined // point or comma
}

export interface RawTable {
  lines: number[] // of the text, from 1, that the rows drawn stand in
  rows: number // of the whole table
  step: number // every so manyth of them is drawn
  /** The numbers of a column, by its place from 0. */
  column: (place: number) => (number | null)[]
}

const marks: Record<string, string | RegExp> = { comma: ',', semicolon: ';', tab: '\t', space: /\s+/ }
const mostDrawn = 50_000
const linesOf = (text: string): string[] => text.split(/\r\n|\n|\r/)

/** null where the page does not find the columns that the program did. */
export function rawTable(text: string, { firstRow, columns, delimiter, decimal }: Layout): RawTable | null {
  const lines = linesOf(text)
  const cellsOf = (line: string, mark: string | RegExp): string[] => line.trim().split(mark)
  const first = lines[firstRow - 1] ?? ''
  const mark = (delimiter ? [marks[delimiter]!] : Object.values(marks)).find((each) => cellsOf(first, each).length === columns)
  if (mark === undefined) return null
  const hasComma = decimal ? decimal === 'comma' : mark !== ',' && /\d,\d/.test(first)
  const all: number[] = []
  for (let i = firstRow - 1; i < lines.length; ++i) if (/^\s*[^\s#%]/.test(lines[i]!)) all.push(i + 1)
  const step = Math.max(1, Math.ceil(all.length / mostDrawn))
  const kept = all.filter((_, i) => i % step === 0)
  const number = (cell: string | undefined): number | null => {
    const value = Number(hasComma ? cell?.replace(',', '.') : cell)
    return cell === undefined || cell.trim() === '' || !Number.isFinite(value) ? null : value
  }
  return {
    lines: kept,
    rows: all.length,
    step,
    column: (place) => kept.map((line) => number(cellsOf(lines[line - 1]!, mark)[place])),
  }
}

/** What stands above the table, and the lines from one to another. */
export const cutText = (text: string, firstRow: number, from: number, to: number): string => {
  const lines = linesOf(text)
  return [...lines.slice(0, firstRow - 1), ...lines.slice(from - 1, to)].join('\n') + '\n'
}
