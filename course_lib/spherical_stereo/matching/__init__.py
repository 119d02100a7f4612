"""Section 2.3: the same object in both panoramas, by the features inside its boxes."""
