"""Run folders: records, fields, workshop files, sign-off.

In the order of a run:

| module                 | responsibility                                                        |
| ---------------------- | --------------------------------------------------------------------- |
| `trial`                | a cam with its solution, checks and smoothing                         |
| `check_records`        | records of checks: table, status by the numbers, verdict in one line  |
| `run_reader`           | a finished run read from its folder; schema of the records            |
| `model_limits`         | limits of the model, for report, sign-off record and documentation    |
| `signoff`              | sign-off record: figures, evidence, validity limits, hashes of files  |
| `signing_keys`         | Ed25519 keys: new, read, trusted                                      |
| `signatures`           | signatures of the sign-off record: in-toto statements, DSSE envelopes |
| `record_schemas`       | JSON Schemas of the records, made of their forms                      |
| `folder_exchange`      | runs and added files take their place, whole at any interruption      |
| `run_folder`           | the folder of a run while it is written; resumption                   |
| `run_records`          | columns of the tables, key figures, records of trial and crank speed  |
| `valve_train`          | machine motion of a valve cam in ``run.json``                         |
| `trial_writer`         | files of a trial                                                      |
| `field_file`           | VTKHDF file of fields over the turn, VTU file of the ends: readers    |
| `contact_zone`         | fine mesh of a body below its contact, interpolation on it            |
| `stress_fields`        | displacement and stress of both bodies over the turn                  |
| `field_output`         | files of ``fields/``                                                  |
| `workshop_files`       | dimensions of the cam; contour table, DXF, STEP, cutter path, sheet   |
| `drawn_cam`            | cam of a finished run as it was certified                             |
| `contact_deck`         | contact at one cam angle as an input deck                             |
| `check_text`           | declaration of a check in words: formula, limit, calculation          |
| `check_report`         | checks of a run as table and lines                                    |
| `junit_report`         | checks of runs and cases as JUnit XML                                 |
| `verdict_summary`      | verdict in few lines: failures, missing data, headline                |
| `file_differences`     | differences of the files of a run from those computed again           |
| `baseline_comparison`  | changes of the checks against a baseline run                          |

| file                       | contents                                             |
| -------------------------- | ---------------------------------------------------- |
| ``run.json``               | summary: versions, verdict, key figures, hashes      |
| ``signoff.json``           | sign-off record                                      |
| ``signoff.intoto.jsonl``   | signatures of that record                            |
| ``1_torque.csv``           | engine torque and its components                     |
| ``1_speed.csv``            | crank speed with and without the cam                 |
| ``trial_N/2_spline.csv``   | knots and coefficients of the lift                   |
| ``trial_N/2_lift.csv``     | lift and its derivatives                             |
| ``trial_N/2_limits.csv``   | utilisation of the limits in a constrained synthesis |
| ``trial_N/3_contour.csv``  | pitch curve and contour                              |
| ``trial_N/4_mesh.msh``     | meshes of cam and follower                           |
| ``trial_N/5_cycle.csv``    | all quantities over the turn, by load case           |
| ``trial_N/5_speed_sweep.csv`` | extremes of the turn over the speed               |
| ``trial_N/5_pressure.npz`` | contact pressure at every position                   |
| ``trial_N/5_guides.npz``   | line load of the guides, pressure in their bores     |
| ``trial_N/5_pivot.npz``    | line load in the bush of a pivot, pressure around it |
| ``trial_N/5_length.npz``   | pressure along the line of contact, ends and tilt    |
| ``trial_N/5_envelope.npz`` | maximum stresses of the turn below the contour       |
| ``trial_N/6_checks.json``  | checks                                               |
| ``trial_N/trial.json``     | smoothing, balance, mesh, certificate, rolling       |
| ``corners.json``           | demands at the tolerance corners                     |
"""
