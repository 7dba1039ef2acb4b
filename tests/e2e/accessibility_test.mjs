// Every page for everybody: what support/every_page.mjs asks, in both themes.
import { testPages } from './support/every_page.mjs';

testPages('dark', 'en');
testPages('light', 'en');
