"""Load histories as evidence: counting, faulty histories, two sets side by side, speed."""
