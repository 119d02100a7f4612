"""The simulated rooms of paper 2: furnished, photographed by two panorama cameras, surveyed as a semantic map."""
