# SPDX-FileCopyrightText: 2026 the tofmap authors
# SPDX-License-Identifier: BSD-3-Clause
"""The kinds of places that look alike, by name. Each is a function of a random generator and of
whether one small object differs between the places. It returns a building and one or more walks;
between two walks the camera is carried without frames."""
from places.halls import cubicles, pillar_hall, ring, shelves
from places.stairs import stairwell, two_storeys
from places.twins import (carried_back, carried_to_twin, five_rooms, five_rooms_once, twin_rooms,
                          twin_rooms_bare)

KINDS = {kind.__name__: kind
         for kind in (twin_rooms, twin_rooms_bare, five_rooms, five_rooms_once, two_storeys,
                      stairwell, shelves, ring, pillar_hall, cubicles, carried_to_twin,
                      carried_back)}
