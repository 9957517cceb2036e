"""Run folders: records, fields, workshop files, sign-off."""
