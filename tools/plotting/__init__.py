"""Figures from CSV files: table.py reads, style.py sets the looks, output.py writes, registry.py lists the figures.

To add an experiment: one module with one function a figure, and one row in registry.py.
"""
