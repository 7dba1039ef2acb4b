// German is longer than English: does it fit, and is no word of English needed to find one's way?
import { testPages } from './support/every_page.mjs';

testPages('dark', 'de');
