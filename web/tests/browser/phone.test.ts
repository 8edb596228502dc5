import { everythingAt } from './widths'

everythingAt(390)
