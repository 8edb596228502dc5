// Every page of the site, in light and dark, at two widths, as files: axe finds nothing, nothing is wider than the page, nothing
// comes from elsewhere, and search finds. usage: node tests/site.mjs FOLDER [PICTURES]      PICTURES: a folder to draw pages into
import { mkdirSync, readdirSync, readFileSync } from 'node:fs'
import { createRequire } from 'node:module'
import { join, relative, resolve } from 'node:path'
import { chromium } from 'playwright-core'
import { chromiumHere } from './chromium.mjs'

const [folder, pictures] = process.argv.slice(2, 4).map((path) => resolve(path))
const axe = readFileSync(createRequire(import.meta.url).resolve('axe-core/axe.min.js'), 'utf8')
const pages = readdirSync(folder, { recursive: true })
  .map((path) => join(folder, path))
  .filter((path) => path.endsWith('.html') && !path.includes('/_static/'))
const wrong = new Set()
const browser = await chromium.launch(chromiumHere())
for (const [width, colorScheme] of [
  [1280, 'light'],
  [390, 'dark'],
]) {
  const context = await browser.newContext({ viewport: { width, height: 900 }, colorScheme, reducedMotion: 'reduce' })
  const page = await context.newPage()
  page.on(
    'request',
    (request) =>
      request.url().startsWith(`file://${folder}/`) || request.url().startsWith('data:') || wrong.add(`asks for ${request.url()}`),
  )
  for (const path of pages) {
    const name = relative(folder, path)
    await page.goto(`file://${path}`)
    if (name === 'index.html') continue // leads to the first page
    await page.evaluate(axe)
    const { violations } = await page.evaluate(() => window.axe.run())
    for (const { id, nodes } of violations) wrong.add(`${name} at ${width}: ${id}: ${nodes[0].html.slice(0, 200)} (${nodes.length})`)
    const wide = await page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth)
    if (wide > 0) wrong.add(`${name} at ${width}: ${wide} px too wide`)
    if (pictures) {
      mkdirSync(pictures, { recursive: true })
      await page.screenshot({ path: join(pictures, `${name.replaceAll('/', '_')}.${width}.png`) })
    }
  }
  await page.goto(`file://${folder}/search.html?q=critical+stiffness`)
  await page.waitForSelector('#search-results li a', { timeout: 10000 }).catch(() => wrong.add(`search at ${width} finds nothing`))
  await context.close()
}
await browser.close()
for (const each of wrong) console.log(each)
console.log(`${pages.length} pages of the site, ${wrong.size} wrong`)
process.exitCode = wrong.size > 0 || pages.length < 10 ? 1 : 0
