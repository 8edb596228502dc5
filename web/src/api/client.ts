// One function from a request to a document. Every number on the page comes from here.

/** Where a problem lies, as far as it is known. */
export interface Place {
  file: string | null // "device", or a recording's name
  line: number | null
  column: number | null
  key: string | null
  option: string | null
}
/** What is wrong with an input, and what to write instead. */
export interface Told {
  where: string
  what: string
  allowed: string
  place: Place
  suggestion: string | null
  code: string | null // the kind of problem, whatever its words
}
const nowhere: Place = { file: null, line: null, column: null, key: null, option: null }
const isOfDevice = (place: Place): boolean => place.file === 'device'

function messageOf({ where, what, allowed, place }: Told): string {
  const column = place.column === null ? '' : `, column ${place.column}`
  const line = place.line === null ? '' : `Line ${place.line}${column} of ${isOfDevice(place) ? 'the device file' : 'the recording'}`
  const name = line && !place.option && !(isOfDevice(place) && place.key) ? '' : where
  return [line, name, what, allowed].filter(Boolean).join(': ')
}

/** Why there is no answer: bad input with its place, or a server that is busy or gone. */
export class Problem extends Error {
  /** The first of `problems`: all of the same input. */
  constructor(
    readonly where: string,
    readonly what: string,
    readonly allowed: string,
    readonly status: number,
    readonly problems: Told[] = [{ where, what, allowed, place: nowhere, suggestion: null, code: null }],
  ) {
    const more = problems.length - 1
    super(messageOf(problems[0]!) + (more > 0 ? `. And ${more} more` : ''))
    const { place } = problems[0]!
    this.line = isOfDevice(place) ? place.line : null
  }
  /** What is wrong with a key of the device file, where something is. */
  ofKey(isIt: (key: string) => boolean): Told | undefined {
    return this.problems.find(({ place }) => isOfDevice(place) && place.key !== null && isIt(place.key))
  }
  /** Not of the question: the server is gone or busy. */
  get isPassing(): boolean {
    return this.status === 0 || this.status === 429 || this.status === 503
  }
  /** In how many seconds the same is asked again, where it is. */
  again: number | null = null
  /** "Asked again in 4 s." */
  get retry(): string {
    return this.again === null ? '' : ` Asked again in ${this.again} s.`
  }
  /** Of the device file, where it is known. */
  readonly line: number | null
}

export const messageIn = (error: unknown): string => (error instanceof Problem ? error.message : String(error))

let token = ''
export const useToken = (given: string): void => {
  token = given
}

async function fetched(path: string, init: RequestInit): Promise<Response> {
  const headers = new Headers(init.headers)
  if (token) headers.set('Authorization', `Bearer ${token}`)
  let response: Response
  try {
    // Nothing of it is in a cache or a cookie: neither is looked for.
    response = await fetch(`/api/v1/${path}`, { ...init, headers, cache: 'no-store', credentials: 'omit' })
  } catch (error) {
    if (init.signal?.aborted) throw error
    throw new Problem('', 'the program does not answer', 'start it again with zwidth serve', 0)
  }
  if (response.ok) return response
  throw problemOf((await response.json().catch(() => null)) as Refused | null, response.status)
}

interface Refused {
  error?: Partial<Told> & { problems?: Told[] }
}
const problemOf = (body: Refused | null, status: number): Problem => {
  const error = body?.error
  return new Problem(error?.where ?? '', error?.what ?? `the server says ${status}`, error?.allowed ?? '', status, error?.problems)
}

const wait = (ms: number): Promise<void> => new Promise((resolve) => setTimeout(resolve, ms))

/** Asks again a few times where the server is busy. */
async function patient(path: string, init: RequestInit): Promise<Response> {
  for (let pause = 100; ; pause *= 2) {
    try {
      return await fetched(path, init)
    } catch (error) {
      if (!(error instanceof Problem && (error.status === 503 || error.status === 429) && pause < 2000)) throw error
      await wait(pause)
    }
  }
}

const lines = 'application/x-ndjson'
interface Listening {
  signal?: AbortSignal // the server ends the work of who leaves
  told?: ((fraction: number) => void) | undefined // where it is given the server tells its progress
}

/** `body` is the JSON of a request, as text, so that who asks can compare it. */
export async function post<T>(path: string, body: string, { signal, told }: Listening = {}): Promise<T> {
  const headers = { 'Content-Type': 'application/json', ...(told ? { Accept: lines } : {}) }
  const response = await patient(path, { method: 'POST', body, headers, ...(signal ? { signal } : {}) })
  if (!told || !response.body || !response.headers.get('Content-Type')?.startsWith(lines)) return (await response.json()) as T
  const document = (await lastLine(response.body, told)) as T & Refused
  if (document.error) throw problemOf(document, 400)
  return document
}

/** The lines before it tell how much is done. */
async function lastLine(body: ReadableStream<Uint8Array>, told: (fraction: number) => void): Promise<unknown> {
  const reader = body.getReader()
  const decoder = new TextDecoder()
  let text = ''
  for (;;) {
    const { done, value } = await reader.read()
    text += decoder.decode(value, { stream: !done })
    if (done) return JSON.parse(text)
    for (let end; text.startsWith('{"progress":') && (end = text.indexOf('\n')) >= 0; text = text.slice(end + 1)) {
      told((JSON.parse(text.slice(0, end)) as { progress: number }).progress)
    }
  }
}

export async function get<T>(path: string): Promise<T> {
  return (await (await patient(path, {})).json()) as T
}

export async function upload<T>(path: string, file: Blob): Promise<T> {
  const response = await patient(path, { method: 'POST', body: file, headers: { 'Content-Type': 'application/octet-stream' } })
  return (await response.json()) as T
}
