/** Placeholder until its panels exist. */
import "../components/site-header.js";
