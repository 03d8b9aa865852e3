/** The index of the design pages. */

import "../components/design-cards.js";
import "../components/site-header.js";
