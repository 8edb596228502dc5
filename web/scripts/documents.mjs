// src/api/generated/documents.ts: the types of the server's documents, from docs/schemas. A part that a schema names (its title) is one type,
// whatever documents it is in: a key that not all of them have is optional there.
import { mkdirSync, readdirSync, readFileSync, writeFileSync } from 'node:fs'

const schemas = new URL('../../docs/schemas/', import.meta.url)
const output = new URL('../src/api/generated/documents.ts', import.meta.url)

/** zwidth.design_sweep/1: DesignSweep. */
const nameOf = (title) => title.replace(/^zwidth\.|\/\d+$/g, '').replace(/(^|_)(\w)/g, (all, _, letter) => letter.toUpperCase())
const isPart = (schema) => schema.properties !== undefined
const typesOf = (schema) => (schema.type === undefined ? [] : [schema.type].flat())
const isUnknown = (schema) => typesOf(schema).length === 0 && !schema.enum && schema.const === undefined
const list = (type) => (/[|&]/.test(type) ? `(${type})[]` : `${type}[]`)

/** Every titled part, by name: all that the schemas have of it. */
const found = new Map()
const collect = (schema) => {
  if (isPart(schema) && schema.title) found.set(nameOf(schema.title), [...(found.get(nameOf(schema.title)) ?? []), schema])
  for (const each of Object.values(schema.properties ?? {})) collect(each)
  for (const key of ['items', 'additionalProperties']) if (typeof schema[key] === 'object') collect(schema[key])
}

/** The alternatives of a value, as texts of TypeScript. */
const alternatives = (schema) => {
  if (schema.const !== undefined) return [JSON.stringify(schema.const)]
  if (schema.enum) return schema.enum.map((each) => JSON.stringify(each))
  if (isUnknown(schema)) return ['unknown']
  return typesOf(schema).map((type) => {
    if (type === 'array') return schema.items ? arrayOf(schema) : 'unknown[]'
    if (type === 'object') return objectOf(schema)
    return type === 'integer' ? 'number' : type
  })
}
const typeOf = (schemas) => {
  // what was always null in one document says nothing where another has it
  const known = schemas.filter((each) => !isUnknown(each))
  const all = new Set((known.length > 0 ? known : schemas).flatMap(alternatives))
  if (known.length > 0 && known.length < schemas.length) all.add('null')
  return [...all].sort((a, b) => (a === 'null') - (b === 'null')).join(' | ')
}
const arrayOf = (schema) => {
  const item = typeOf([schema.items])
  return schema.minItems === 2 && schema.maxItems === 2 ? `[${item}, ${item}]` : list(item)
}
const objectOf = (schema) => {
  if (isPart(schema)) return schema.title ? nameOf(schema.title) : membersOf([schema])
  return `Record<string, ${typeof schema.additionalProperties === 'object' ? typeOf([schema.additionalProperties]) : 'unknown'}>`
}
const membersOf = (parts) => {
  const keys = [...new Set(parts.flatMap((each) => Object.keys(each.properties)))]
  const members = keys.map((key) => {
    const having = parts.filter((each) => key in each.properties)
    const always = having.length === parts.length && having.every((each) => each.required.includes(key))
    const told = having[0].properties[key].description
    return `/** ${told} */\n${key}${always ? '' : '?'}: ${typeOf(having.map((each) => each.properties[key]))}\n`
  })
  return `{\n${members.join('')}}`
}

for (const file of readdirSync(schemas).sort()) {
  if (file.endsWith('.json')) collect(JSON.parse(readFileSync(new URL(file, schemas), 'utf8')))
}
/** Every line indented by the braces around it. */
const indented = (text) => {
  let depth = 0
  return text.replace(/^(\}?).*?(\{?)$/gm, (line, closes, opens) => {
    depth -= closes.length
    const told = '  '.repeat(depth) + line
    depth += opens.length
    return told
  })
}
const types = [...found].map(([name, parts]) => indented(`export interface ${name} ${membersOf(parts)}`) + '\n')
mkdirSync(new URL('.', output), { recursive: true })
writeFileSync(output, `// Written by web/scripts/documents.mjs from docs/schemas.\n\n${types.join('\n')}`)
