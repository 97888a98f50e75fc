"""The report of a Gumshoe result: reads the HDF5 file only, writes HTML and CSV."""
