"""Cards of materials, bushes, oils and spring wires, shipped and the user's own."""
