// Which Chromium the tests and pictures are made with, and how it starts. The headless shell is the same engine without the
// desktop around it: half the work of the processor.
import { existsSync } from 'node:fs'

/** Options of playwright's launch(). */
export const chromiumHere = () => {
  const names = ['chromium-headless-shell', 'chromium', 'chromium-browser'].map((name) => `/usr/bin/${name}`)
  const found = [process.env.CHROMIUM, ...names].find((path) => path && existsSync(path))
  if (!found) throw new Error('no Chromium; install Debian’s package chromium-headless-shell or name a program in CHROMIUM')
  return { executablePath: found, args: process.getuid?.() === 0 ? ['--no-sandbox', '--disable-gpu', '--disable-software-rasterizer'] : [] }
}
