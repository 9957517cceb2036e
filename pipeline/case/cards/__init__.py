"""Cards of materials, bushes, oils, wires, gas springs, bearings; catalogues of their parts.

In the order of use; the values are in the TOML files of this folder.

| module             | responsibility                             | symbol, unit         |
| ------------------ | ------------------------------------------ | -------------------- |
| `part_table`       | a part from a table, errors in one line    | SI                   |
| `provenance`       | source, place and condition of each number |                      |
| `bearing_cards`    | ball bearings: ratings, dimensions         | C, C0, N; m          |
| `shaft_seats`      | bore, keyway and bearing of a camshaft     | C, C0, N; m          |
| `spring_catalogue` | springs of a catalogue, demand on a spring | k, N/m; P, N; s, m   |
| `spring_selection` | lightest spring of a catalogue for a case  | kg                   |
| `card_filling`     | keys of a case from its cards              | nu, mm2/s; eta, Pa s |
| `catalogue`        | rollers, springs and bushes of a redesign  | N; N/m; Pa, Pa m/s   |
| `substitution`     | a case with other parts                    | m, kg                |

Imports what `pipeline.case` does; `pipeline.case.case_file` imports it.
"""
