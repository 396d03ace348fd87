"""Parts of `evaluate.py`: what dances are made, how they are measured, how it is told."""
