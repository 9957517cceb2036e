"""Report of a finished run: page, PDF, scene, pictures; pages of studies. Nothing is solved.

Modules in the order of use; each imports only those above it.

====================== ===========================================================================
check_parts            part of the mechanism that a check judges
report_tables          digits, units and text of a value; rows of checks, key figures and inputs
machine_words          names of the machine's shaft, of the parts of its cycle
verification_tables    certificate, benchmarks, tolerance corners, shadow prices, consistency
verdict_text           verdict in sentences
figure_layout          vertical axis of a panel, places of the labels of its limits
outline_figures        outlines of a cam in the direction of its shaft
sheet_turn             one load case over a cam turn (`Turn`); curves from its columns
arrangement_data       sizes and motion of the mechanism, its drawing at a cam angle
part_figures           figures of forces, guides, pivot, roller, film, spring, pin, ring, key, shaft
analysis_sheet         figures of torque, shape, limits and contact; all groups in order
report_data            a run folder, read once (`Material`)
figure_svg             figures as SVG and PNG by matplotlib
interactive            figures as data for Plotly in the page
field_raster           axes, colour bar and contact pressure around a picture of a field
field_picture          von Mises stress below the contact and in both bodies, by VTK off screen
stress_map             maximum stress of the turn below the contour, unrolled and in place
pressure_figures       pressure in guides or pivot and along the line of contact
picture_list           pictures of a report with title and caption
utilisation_chart      chart of the greatest utilisations by part
report_content         sections, blocks, text and tables of a report (`Report`)
live_preview           sliders and quantities of the live preview of the page
page                   ``8_report.html`` and the pages of studies, by Jinja
pdf                    documents as PDF/A, by typst
documents              ``8_signoff.pdf``, ``8_report.pdf``, shop drawing, spreadsheets
motion_svg             ``motion.svg``: the mechanism over one turn, animated
scene_solids           rings, boxes and rods as triangles
scene_arm              solids of second arm, output and spring of an arm, with their poses
scene_groove           solids of a disc with a groove, and of the follower before it
scene_second           solids of a second roller or face that pulls, and of its disc
scene_page             ``scene.html``: interactive 3-D view over the turn
sections               parts of a report by name; `report` writes them
====================== ===========================================================================
"""
