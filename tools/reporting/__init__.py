"""The page on the engines, from tables and notes."""
