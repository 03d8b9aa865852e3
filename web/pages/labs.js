/** The list of labs. */

import "../components/labs-list.js";
import "../components/site-header.js";
