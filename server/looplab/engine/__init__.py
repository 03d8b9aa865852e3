"""Control theory on exact dead time: numpy and scipy only, useful from a notebook without the web."""
