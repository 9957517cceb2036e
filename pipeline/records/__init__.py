"""Forms of the JSON records: types of the code, and their schemas.

| module                | responsibility                                             |
| --------------------- | ---------------------------------------------------------- |
| `forms`               | declaration of a form: bounds, conditions, meaning of keys |
| `check_record`        | ``6_checks.json``                                          |
| `run_summary`         | ``run.json``                                               |
| `trial_contents`      | ``trial.json``                                             |
| `corners_document`    | ``corners.json``                                           |
| `signoff_record`      | ``signoff.json``                                           |
| `check_document`      | output of ``check --json``                                 |
| `crown_document`      | ``crown.json``, output of ``design crown --json``          |
| `size_document`       | output of ``design sizes --json``                          |
| `judgement_record`    | judgements of changed cases, as a search stores them       |
| `redesign_document`   | ``redesign.json``, output of ``design parts --json``       |
| `design_document`     | ``design.json``, output of ``design machine --json``       |
| `inspection_document` | ``inspection.json``, output of ``inspect --json``          |
| `study_document`      | ``study.json``                                             |
| `live_document`       | ``8_live.json``                                            |

Imports `geometry` and `base`.
"""
