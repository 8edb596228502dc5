// What is copied runs nothing but the program, and holds the text to the letter, whatever stands in it.
import { execFileSync, spawn } from 'node:child_process'
import { once } from 'node:events'
import { fileURLToPath } from 'node:url'
import { describe, expect, it } from 'vitest'
import { commandLine, cppCode, pythonCode } from '../../src/model/commands'

const hostile = [
  'name = "a"\nEND_OF_DEVICE\necho RAN\n',
  'END_OF_DEVICE\nEND_OF_DEVICE1\nEND_OF_DEVICE2\necho RAN',
  'name = "$(echo RAN) `echo RAN` ${HOME} \\" \' \\\\"\n',
  "END_OF_DEVICE\r\n\u001b[201~\necho RAN\u0003\n'; echo RAN #\n%s %d \\101 \u009b\n",
  'name = \'a)toml", system("touch x"), R"toml(\'\n# )toml1" )toml2"\n',
  'x = """a""""\n"""\nimport os\n\\"""\n""',
  'ends in "',
]
const run = (program: string, ...words: string[]): string => execFileSync(program, words, { encoding: 'utf8' })
const ended = (text: string): string => text.replace(/\n*$/, '\n')

describe('commands', () => {
  it('give a shell the text and nothing else', () => {
    for (const text of hostile) {
      const command = commandLine('analyze', {}, text)
      run('bash', '-n', '-c', command)
      const got = run('bash', '-c', `zwidth() { cat; }\n${command}`)
      expect(ended(got), command).toBe(ended(text))
      expect(run('bash', '-c', `zwidth() { printf '%s' "$*"; cat >/dev/null; }\n${command}`), command).toBe('analyze -')
    }
    expect(
      run(
        'bash',
        '-c',
        `zwidth() { printf '%s|' "$@"; cat >/dev/null; }\n${commandLine('design', { target: "a\u0003'\\ $HOME %" }, hostile[0]!)}`,
      ),
    ).toBe("design|-|--target|a\u0003'\\ $HOME %|")
    expect(
      run(
        'bash',
        '-c',
        `zwidth() { printf '%s|' "$@"; cat >/dev/null; }\n${commandLine('design', { target: "1 'N/m'; echo RAN" }, hostile[0]!)}`,
      ),
    ).toBe("design|-|--target|1 'N/m'; echo RAN|")
  })

  it('give C++ one raw string', () => {
    for (const text of hostile) {
      const code = cppCode(text)
      const [, end, rest] = /R"([^()\\\s]{0,16})\(([^]*)$/.exec(code)!
      const close = rest!.indexOf(`)${end}"`)
      expect(rest!.slice(0, close)).toBe(text)
      expect(rest!.slice(close)).toMatch(/^\)\w+", "workbench"\);\n/)
    }
  })

  it('give C++ that compiles against the library, and prints every digit', { timeout: 600_000 }, async () => {
    const code = cppCode('name = "a"\n[[body]]\nname = "a"\nmass = 1\n[loop]\nsampling_period = 1e-3\n')
    const words = [
      '-std=c++20',
      '-fsyntax-only',
      '-I',
      fileURLToPath(new URL('../../../include', import.meta.url)),
      '-isystem',
      '/usr/include/eigen3',
      '-x',
      'c++',
      '-',
    ]
    const compiler = spawn('c++', words, { stdio: ['pipe', 'inherit', 'inherit'] }) // while vitest's worker goes on
    compiler.stdin.end(code)
    expect(await once(compiler, 'exit')).toEqual([0, null])
    expect(code).toContain('setprecision(17) << analysis.critical.stiffness')
  })

  it('give Python one text', () => {
    for (const text of hostile) {
      const code = pythonCode(text)
      const print =
        'import ast, sys\ntree = ast.parse(sys.argv[1])\nassert [type(each).__name__ for each in tree.body] == ["Import", "Assign", "Assign", "Expr"]\nsys.stdout.buffer.write(tree.body[1].value.args[0].value.encode())'
      expect(run('python3', '-c', print, code), code).toBe(text.includes('\n') ? text : `${text}\n`)
    }
  })
})
