/** The plant library. */

import "../components/plants-gallery.js";
import "../components/site-header.js";
