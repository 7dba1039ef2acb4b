import * as admin from '../admin/text';
import * as overview from '../overview/text';
import * as results from '../results/text';
import * as sequence from '../sequence/text';
import * as shell from '../shell/text';

/** Each folder owns its texts: `useTranslation('overview')` reads src/overview/text.ts. */
export const texts = { admin, overview, results, sequence, shell };
