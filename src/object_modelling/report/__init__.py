"""report.html of an object in the database: one file, readable without network; docs/report.md."""
