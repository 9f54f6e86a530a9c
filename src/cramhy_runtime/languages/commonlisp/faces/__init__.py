"""The faces of the rooms: which package shows what of which room, under which names."""
