import { everythingAt } from './widths'

everythingAt(1280)
