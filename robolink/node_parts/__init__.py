"""Parts of which Node is made: entities, graph queries, parameters, and the publisher of /rosout."""
