"""What the laboratory adds to ``import yehu_server``; docs/python.md describes it."""
