"""Systems with dead times anywhere inside them."""
